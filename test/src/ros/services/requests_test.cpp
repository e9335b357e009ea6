// A request may set the fields that its shape, kind or operation uses, and no others.

#include "src/ros/services/requests.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "test/support/ros/request_fields.hpp"

namespace {

using namespace desert_sim;
using node_test::fields_of;

const TerrainTransforms frames("map");
const DataFolder files("/no/folder");

/// Sets each field in turn: it is refused by its name if it is not one of those that are used.
template <class Request, class Make>
void expect_used(const Request& base, const std::set<std::string>& used, const std::string& user,
                 const Make& make) {
  ASSERT_NO_THROW(make(base)) << user;
  for (const auto& field : fields_of(base)) {
    Request request = base;
    field.set(request);
    std::string refusal;
    try {
      make(request);
    } catch (const ConfigError& error) {
      refusal = error.what();
    }
    if (used.count(field.name))
      EXPECT_EQ(refusal.find(": is set, but"), std::string::npos) << refusal;
    else
      EXPECT_EQ(refusal.find(field.name + ": is set, but " + user), 0u)
          << field.name << " with " << user << ": '" << refusal << "'";
  }
}

template <class Request>
Request with(Request request, const std::vector<std::string>& names) {
  for (const auto& field : fields_of(request))
    if (std::count(names.begin(), names.end(), field.name)) field.set(request);
  return request;
}

template <class T>
std::set<T> operator+(std::set<T> all, const std::set<T>& more) {
  all.insert(more.begin(), more.end());
  return all;
}

const std::set<std::string> turned{"center", "radius", "radius_y", "angle_deg"};

TEST(Requests, EditTerrainRefusesWhatItsShapeDoesNotUse) {
  const std::map<std::string, std::set<std::string>> shapes{
      {"circle", {"center", "radius", "inner"}},
      {"ellipse", turned + std::set<std::string>{"inner"}},
      {"rectangle", turned + std::set<std::string>{"inner"}},
      {"capsule", {"points", "radius", "inner"}},
      {"polygon", {"points", "falloff"}}};
  // Fields of merge and conserve are not the shape's.
  const std::set<std::string> others{"value", "smooth_radius", "smooth_passes", "ring_width"};
  for (const auto& [shape, used] : shapes) {
    EditTerrainRequest request;
    request.layer = "sand";
    request.shape = shape;
    request.merge = "add";
    for (const auto& field : fields_of(request)) {
      if (others.count(field.name)) continue;
      EditTerrainRequest set = request;
      field.set(set);
      if (used.count(field.name))
        EXPECT_NO_THROW(edit_command(set, frames, files)) << shape << ", " << field.name;
      else
        EXPECT_THROW(edit_command(set, frames, files), ConfigError) << shape << ", " << field.name;
    }
  }
}

TEST(Requests, EditTerrainRefusesWhatMergeConserveAndImageDoNotUse) {
  const auto make = [](const EditTerrainRequest& request) { return edit_command(request, frames, files); };
  EditTerrainRequest request;
  request.layer = "sand";
  request.shape = "circle";
  request.merge = "add";
  EditTerrainRequest set = with(request, {"smooth_radius"});
  EXPECT_THROW(make(set), ConfigError);
  EXPECT_THROW(make(with(request, {"smooth_passes"})), ConfigError);
  EXPECT_THROW(make(with(request, {"ring_width"})), ConfigError);
  EXPECT_NO_THROW(make(with(request, {"value"})));
  request.conserve = true;
  EXPECT_NO_THROW(make(with(request, {"ring_width"})));
  request.merge = "smooth";
  EXPECT_NO_THROW(make(with(request, {"smooth_radius", "smooth_passes"})));
  EXPECT_THROW(make(with(request, {"value"})), ConfigError);

  EditTerrainRequest patch = with(EditTerrainRequest(), {"center", "radius", "radius_y", "image"});
  patch.layer = "sand";
  patch.shape = "patch";
  patch.merge = "add";
  expect_used(patch, turned + std::set<std::string>{"image", "image_use", "image_scale", "falloff", "value"},
              "", [&](const EditTerrainRequest& r) {
                try {
                  return make(r);
                } catch (const ConfigError& error) {  // whoever does not use it
                  const std::string text = error.what();
                  const std::size_t end = text.find("but ");
                  throw ConfigError(end == std::string::npos ? text : text.substr(0, end + 4));
                }
              });
  patch.image_use = "mask";
  EXPECT_NO_THROW(make(patch));
  EXPECT_THROW(make(with(patch, {"image_scale"})), ConfigError);
}

TEST(Requests, TheRefusalNamesFieldAndShape) {
  EditTerrainRequest request;
  request.layer = "sand";
  request.shape = "circle";
  request.merge = "add";
  request.radius = 2;
  request.points = {node_test::point_at(20, 20)};
  try {
    edit_command(request, frames, files);
    FAIL() << "a circle at (0, 0)";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "points: is set, but shape 'circle' does not use it (allowed: leave it out)");
  }
}

TEST(Requests, EditPlantsRefusesWhatIsNotUsed) {
  const auto make = [](const EditPlantsRequest& request) { return plants_command(request, frames); };
  EditPlantsRequest request;
  request.operation = "plant";
  request.shape = "circle";
  expect_used(request, {"center", "radius", "density", "size", "seed"}, "shape 'circle'", make);
  request.shape = "capsule";
  expect_used(request, {"points", "radius", "density", "size", "seed"}, "shape 'capsule'", make);
  request.operation = "clear";
  for (const char* name : {"density", "size", "seed"})
    EXPECT_THROW(make(with(request, {name})), ConfigError) << name;
}

TEST(Requests, EditWindRefusesWhatIsNotUsed) {
  const auto make = [](const EditWindRequest& request) { return wind_edit_command(request, frames); };
  const std::set<std::string> all{"id",    "kind", "center",   "radius", "speed",
                                  "begin", "end",  "velocity", "path"};
  EditWindRequest request;
  for (const char* operation : {"add", "change"}) {
    request.operation = operation;
    request.kind = "vortex";
    expect_used(request, all, "kind 'vortex'", make);
    request.kind = "jet";
    // The field `kind` itself, which makes it a vortex.
    for (const char* name : {"direction_deg", "length"}) EXPECT_NO_THROW(make(with(request, {name}))) << name;
    for (const char* name : {"scale", "life_time", "seed"})
      EXPECT_THROW(make(with(request, {name})), ConfigError) << name;
    request.kind = "turbulence";
    for (const char* name : {"scale", "life_time", "seed"})
      EXPECT_NO_THROW(make(with(request, {name}))) << name;
    for (const char* name : {"direction_deg", "length"})
      EXPECT_THROW(make(with(request, {name})), ConfigError) << name;
    request.kind = "sink";
    for (const char* name : {"direction_deg", "length", "scale", "life_time", "seed"})
      EXPECT_THROW(make(with(request, {name})), ConfigError) << name;
    EXPECT_NO_THROW(make(with(request, {"path", "begin", "end"})));
    for (const char* name : {"center", "velocity"})
      EXPECT_THROW(make(with(request, {"path", name})), ConfigError) << name;
  }
  request = EditWindRequest();
  request.operation = "remove";
  expect_used(request, {"id"}, "operation 'remove'", make);
  request.operation = "clear";
  expect_used(request, {}, "operation 'clear'", make);
}

TEST(Requests, WindsRefuseWhatIsNotUsed) {
  SetWindRequest wind;
  expect_used(wind, {"speed", "direction_deg"}, "use_vector is false", wind_command);
  wind.use_vector = true;
  expect_used(wind, {"vector"}, "use_vector is true", wind_command);

  SetWindScheduleRequest schedule;
  schedule.segments.resize(2);
  for (const std::string kind : {"timeline", "rose"}) {
    schedule.kind = kind;
    const bool rose = kind == "rose";
    expect_used(schedule, rose ? std::set<std::string>{"hold_time", "seed"} : std::set<std::string>{"repeat"},
                "kind '" + kind + "'", wind_schedule_command);
    for (double WindScheduleSegment::*const member :
         {&WindScheduleSegment::duration, &WindScheduleSegment::ramp, &WindScheduleSegment::probability}) {
      SetWindScheduleRequest set = schedule;
      set.segments[1].*member = 1;
      const bool used = rose == (member == &WindScheduleSegment::probability);
      if (used)
        EXPECT_NO_THROW(wind_schedule_command(set)) << kind;
      else
        EXPECT_THROW(wind_schedule_command(set), ConfigError) << kind;
    }
  }
}

TEST(Requests, SetWeatherNamesTheFieldsThereAre) {
  SetWeatherRequest request;
  const auto refusal = [&request]() -> std::string {
    try {
      weather_command(request);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  const std::string known =
      "rain_rate, rain_share, evaporation, ground_evaporation, sea_level, wave_strength, "
      "wave_period, sea, springs";
  request.rain_rate = 0.001;
  EXPECT_NE(refusal().find("change: is empty (allowed: fields to change, of " + known), std::string::npos)
      << refusal();
  request.change = {"rain"};
  EXPECT_NE(refusal().find("change: 'rain' is not one of: " + known), std::string::npos) << refusal();
}

TEST(Requests, SetWeatherRefusesWhatItDoesNotChange) {
  SetWeatherRequest request;
  request.change = {"rain_rate"};
  expect_used(request, {"rain_rate"}, "`change` does not name it", weather_command);
  request.change = {"sea", "sea_level"};
  request.sea = "none";
  expect_used(request, {"sea", "sea_level"}, "`change` does not name it", weather_command);
}

}  // namespace
