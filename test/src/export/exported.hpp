#pragma once
/// Terrains to export, and readers of what is written, for tests of src/export.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "src/export/exported_terrain.hpp"
#include "test/support/temporary_folder.hpp"

namespace export_test {

using namespace desert_sim;

using Height = std::function<double(int x, int y)>;

/// A terrain whose heights differ from cell to cell and in both directions, with rock, sand and a pond.
inline std::shared_ptr<Snapshot> dunes(int width, int height, bool periodic = false) {
  auto s = std::make_shared<Snapshot>();
  s->width = width;
  s->height = height;
  s->cell_size = 2;
  s->origin_x = 1000;
  s->origin_y = -300;
  s->periodic_x = s->periodic_y = periodic;
  s->step = 7;
  const auto layer = [&](Layer name, const Height& value) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) s->layers[name].push_back(static_cast<float>(value(x, y)));
  };
  layer(Layer::elevation,
        [](int x, int y) { return -3.3 + 2.1 * x - 0.37 * y + 1.7 * ((5 * x + 3 * y) % 7); });
  layer(Layer::sand, [](int x, int y) { return x % 3 == 0 && y < 2 ? 0.0 : 1.0; });
  layer(Layer::water, [](int x, int y) { return x >= 2 && y >= 2 ? 0.5 : 0.0; });
  return s;
}

inline ExportedTerrain terrain_of(const std::shared_ptr<const Snapshot>& snapshot) {
  return {snapshot, nullptr};
}

inline float elevation(const Snapshot& s, int x, int y) {
  return s.find(Layer::elevation)->at(static_cast<std::size_t>(y * s.width + x));
}

using Triple = std::array<double, 3>;

struct ReadMesh {
  std::vector<Triple> vertices, colours;  ///< colours: red, green, blue, as in the file
  std::vector<std::array<std::size_t, 3>> faces;
};

/// Takes numbers out of bytes, one after the other.
class Bytes {
 public:
  explicit Bytes(std::string bytes, std::size_t at = 0) : bytes_(std::move(bytes)), at_(at) {}
  template <class Number>
  Number next() {
    Number number;
    EXPECT_LE(at_ + sizeof number, bytes_.size()) << "the file ends too early";
    if (at_ + sizeof number > bytes_.size()) return Number{};
    std::memcpy(&number, bytes_.data() + at_, sizeof number);
    at_ += sizeof number;
    return number;
  }
  Triple floats() {
    const double x = next<float>(), y = next<float>();
    return {x, y, next<float>()};
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_;
};

inline std::size_t count_after(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word);
  EXPECT_NE(at, std::string::npos) << word;
  return at == std::string::npos ? 0 : std::stoul(text.substr(at + word.size()));
}

inline ReadMesh read_ply(const std::string& path) {
  const std::string text = test::file_bytes(path), end = "end_header\n";
  EXPECT_EQ(text.rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);
  Bytes bytes(text, text.find(end) + end.size());
  ReadMesh mesh;
  for (std::size_t n = count_after(text, "element vertex "); n > 0; --n) {
    mesh.vertices.push_back(bytes.floats());
    EXPECT_GT(bytes.floats()[2], 0) << "normals look up";
    const double red = bytes.next<std::uint8_t>(), green = bytes.next<std::uint8_t>();
    mesh.colours.push_back({red, green, static_cast<double>(bytes.next<std::uint8_t>())});
  }
  for (std::size_t n = count_after(text, "element face "); n > 0; --n) {
    EXPECT_EQ(bytes.next<std::uint8_t>(), 3);
    std::array<std::size_t, 3> face;
    for (std::size_t& corner : face) corner = static_cast<std::size_t>(bytes.next<std::int32_t>());
    mesh.faces.push_back(face);
  }
  EXPECT_TRUE(bytes.at_end());
  return mesh;
}

/// Corners are vertices of their own in such a file.
inline ReadMesh read_stl(const std::string& path, std::vector<Triple>& normals) {
  const std::string text = test::file_bytes(path);
  EXPECT_NE(text.rfind("solid", 0), 0u) << "that is how texts begin";
  Bytes bytes(text, 80);
  ReadMesh mesh;
  for (std::size_t n = bytes.next<std::uint32_t>(); n > 0; --n) {
    normals.push_back(bytes.floats());
    const std::size_t first = mesh.vertices.size();
    for (int corner = 0; corner < 3; ++corner) mesh.vertices.push_back(bytes.floats());
    mesh.faces.push_back({first, first + 1, first + 2});
    EXPECT_EQ(bytes.next<std::uint16_t>(), 0);
  }
  EXPECT_TRUE(bytes.at_end());
  return mesh;
}

struct ObjGroup {
  ReadMesh mesh;
  std::vector<std::array<double, 2>> places;  ///< in the picture
  std::string material;
};

/// The groups by name; faces count the vertices of their own group.
inline std::map<std::string, ObjGroup> read_obj(const std::string& path) {
  std::istringstream text(test::file_bytes(path));
  std::map<std::string, ObjGroup> groups;
  ObjGroup* group = nullptr;
  std::size_t before = 0, all = 0;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string key, word;
    words >> key;
    if (key == "o") {
      words >> word;
      group = &groups[word];
      before = all;
    } else if (key == "usemtl") {
      words >> group->material;
    } else if (key == "v") {
      Triple place, colour;
      words >> place[0] >> place[1] >> place[2] >> colour[0] >> colour[1] >> colour[2];
      EXPECT_TRUE(words) << line;
      group->mesh.vertices.push_back(place);
      group->mesh.colours.push_back(colour);
      ++all;
    } else if (key == "vt") {
      std::array<double, 2> place;
      words >> place[0] >> place[1];
      group->places.push_back(place);
    } else if (key == "f") {
      std::array<std::size_t, 3> face;
      for (std::size_t& corner : face) {
        words >> word;
        corner = std::stoul(word) - 1 - before;
        if (const std::size_t slash = word.find('/'); slash != std::string::npos) {
          EXPECT_EQ(std::stoul(word.substr(slash + 1)) - 1, corner) << "that vertex's place in the picture";
        }
      }
      group->mesh.faces.push_back(face);
    }
  }
  return groups;
}

struct GlbMesh {
  ReadMesh mesh;  ///< turned back: z is up
  Triple low, high;
  nlohmann::json material;
};

/// By the name of the node.
inline std::map<std::string, GlbMesh> read_glb(const std::string& path) {
  const std::string text = test::file_bytes(path);
  Bytes header(text);
  EXPECT_EQ(header.next<std::uint32_t>(), 0x46546c67u) << "glTF";
  EXPECT_EQ(header.next<std::uint32_t>(), 2u);
  EXPECT_EQ(header.next<std::uint32_t>(), text.size());
  const std::size_t length = header.next<std::uint32_t>();
  EXPECT_EQ(header.next<std::uint32_t>(), 0x4e4f534au) << "JSON";
  const nlohmann::json scene = nlohmann::json::parse(text.substr(20, length));
  Bytes chunk(text, 20 + length);
  EXPECT_EQ(chunk.next<std::uint32_t>(), text.size() - 28 - length);
  EXPECT_EQ(chunk.next<std::uint32_t>(), 0x004e4942u) << "BIN";
  const auto data = [&](const nlohmann::json& accessor, int component, const std::string& type) {
    EXPECT_EQ(accessor["componentType"], component);
    EXPECT_EQ(accessor["type"], type);
    const nlohmann::json& view = scene["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    return Bytes(text, 28 + length + view.value("byteOffset", std::size_t{0}));
  };
  std::map<std::string, GlbMesh> meshes;
  for (const nlohmann::json& node : scene["nodes"]) {
    GlbMesh& mesh = meshes[node["name"]];
    const nlohmann::json& primitive = scene["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
    const auto accessor = [&](const nlohmann::json& number) -> const nlohmann::json& {
      return scene["accessors"][number.get<std::size_t>()];
    };
    const nlohmann::json& positions = accessor(primitive["attributes"]["POSITION"]);
    Bytes places = data(positions, 5126, "VEC3");
    Bytes colours = data(accessor(primitive["attributes"]["COLOR_0"]), 5123, "VEC4");
    EXPECT_EQ(accessor(primitive["attributes"]["COLOR_0"])["normalized"], true);
    Bytes normals = data(accessor(primitive["attributes"]["NORMAL"]), 5126, "VEC3");
    for (std::size_t n = positions["count"]; n > 0; --n) {
      const Triple p = places.floats();
      mesh.mesh.vertices.push_back({p[0], -p[2], p[1]});
      if (node["name"] != "plants") {
        EXPECT_GT(normals.floats()[1], 0) << "up is y";
      }
      const double red = colours.next<std::uint16_t>(), green = colours.next<std::uint16_t>();
      mesh.mesh.colours.push_back({red, green, static_cast<double>(colours.next<std::uint16_t>())});
      colours.next<std::uint16_t>();
    }
    const nlohmann::json& corners = accessor(primitive["indices"]);
    Bytes indices = data(corners, 5125, "SCALAR");
    for (std::size_t n = corners["count"].get<std::size_t>() / 3; n > 0; --n) {
      std::array<std::size_t, 3> face;
      for (std::size_t& corner : face) corner = indices.next<std::uint32_t>();
      mesh.mesh.faces.push_back(face);
    }
    mesh.low = positions["min"];
    mesh.high = positions["max"];
    mesh.material = scene["materials"][primitive["material"].get<std::size_t>()];
  }
  return meshes;
}

/// Twice the area of a triangle as seen from above [m²]: positive where it goes round counter-clockwise.
inline double area_from_above(const ReadMesh& mesh, const std::array<std::size_t, 3>& face) {
  const Triple &a = mesh.vertices.at(face[0]), &b = mesh.vertices.at(face[1]), &c = mesh.vertices.at(face[2]);
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Every vertex lies at the centre of a cell and at its height, every cell has one, and the triangles cover
/// the terrain once, with their upper side upwards.
inline void expect_ground(const ReadMesh& mesh, const Snapshot& s) {
  std::vector<bool> seen(static_cast<std::size_t>(s.width * s.height));
  for (const Triple& v : mesh.vertices) {
    const double x = v[0] / s.cell_size - 0.5, y = v[1] / s.cell_size - 0.5;
    ASSERT_NEAR(x, std::round(x), 1e-6);
    ASSERT_NEAR(y, std::round(y), 1e-6);
    const int column = static_cast<int>(std::round(x)), row = static_cast<int>(std::round(y));
    ASSERT_TRUE(column >= 0 && column < s.width && row >= 0 && row < s.height) << column << " " << row;
    EXPECT_EQ(static_cast<float>(v[2]), elevation(s, column, row)) << column << " " << row;
    seen[static_cast<std::size_t>(row * s.width + column)] = true;
  }
  for (const bool cell : seen) EXPECT_TRUE(cell);
  double area = 0;
  for (const auto& face : mesh.faces) {
    EXPECT_GT(area_from_above(mesh, face), 0);
    area += area_from_above(mesh, face) / 2;
  }
  EXPECT_EQ(mesh.faces.size(), static_cast<std::size_t>(2 * (s.width - 1) * (s.height - 1)));
  EXPECT_NEAR(area, s.cell_size * s.cell_size * (s.width - 1) * (s.height - 1), 1e-6);
}

}  // namespace export_test
