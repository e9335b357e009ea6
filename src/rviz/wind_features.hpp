#pragma once
/// Local features of the wind as the tool and the form show and edit them: requests of ~edit_wind, words and
/// outlines. They know neither OGRE nor Qt.

#include <desert_sim/EditWind.h>
#include <desert_sim/WindFeatureItem.h>

#include <optional>
#include <string>
#include <vector>

#include "src/render/colour.hpp"
#include "src/render/height_field.hpp"

namespace desert_sim {

using WindFeatures = std::vector<WindFeatureItem>;

/// Which numbers a kind of feature has, beside centre, radius and speed.
inline bool has_direction(const WindFeatureItem& f) { return f.kind == EditWind::Request::JET; }
inline bool has_eddies(const WindFeatureItem& f) { return f.kind == EditWind::Request::TURBULENCE; }

/// Whether the feature is there at a simulated time [s], and where its centre is then, in the terrain's
/// frame.
bool is_there(const WindFeatureItem& feature, double time);
render::Place centre_at(const WindFeatureItem& feature, double time);
/// Moves the feature, and its whole path, so that its centre is at a place at that time.
void put_at(WindFeatureItem& feature, const render::Place& place, double time);

/// The request that adds or changes this feature: without the numbers that its kind does not have.
EditWind::Request wind_request(const std::string& operation, const WindFeatureItem& feature);
EditWind::Request wind_removal(int id);

/// The least id above `after` that no feature has; from 1 on again after the largest one.
int free_id(const WindFeatures& features, int after);
/// Does to the list what a request has done to that of the node.
void apply_to(WindFeatures& features, const EditWind::Request& done);

/// A path as "0 100 40; 60 180 40": time [s], x and y [m] of each point. Reading it: null if it is something
/// else, and empty if the text is.
std::string path_text(const WindFeatureItem& feature);
std::optional<std::vector<WindFeaturePoint>> path_of(const std::string& text);

/// Such as "vortex 3: 5 m/s, radius 20 m".
std::string words_of(const WindFeatureItem& feature);

/// Lines on the map, in the terrain's frame, that show place, size and sense at a time: a vortex is a circle
/// whose arrows turn as it does, a sink one with arrows towards its centre, a jet an arrow of its length in
/// an ellipse, turbulence a broken circle with eddies; each has a cross in its centre, and its path if it has
/// one.
std::vector<std::vector<render::Place>> outline(const WindFeatureItem& feature, double time);
/// Half the width of that cross [m].
double cross_of(const WindFeatureItem& feature);
render::PackedColour feature_colour(const WindFeatureItem& feature);

}  // namespace desert_sim
