#pragma once
/// OGRE materials of the plugins. Vertices have their colours with the light of the sun in them (src/render),
/// so that no shader and no light of the scene is needed: that is what software rasterisers are fast at.

#include <OgreMaterial.h>

namespace desert_sim::materials {

/// Opaque. Lies a little behind its place, so that lines on it are seen. A new one for each call, of which
/// the caller takes leave by remove(): it can have textures of its own (GroundCoat, RipplesView).
Ogre::MaterialPtr new_ground();
void remove(const Ogre::MaterialPtr& material);
/// Behind everything, at any depth.
Ogre::MaterialPtr sky();
/// Translucent by the alpha of the vertices.
Ogre::MaterialPtr translucent();
/// Opaque.
Ogre::MaterialPtr shapes();
/// Translucent by the alpha of the vertices, and seen through everything: what tools draw.
Ogre::MaterialPtr marks();
/// Lines so many pixels wide, translucent by the alpha of the vertices.
Ogre::MaterialPtr lines(int pixels);
/// The same, seen through everything.
Ogre::MaterialPtr lines_behind(int pixels);

}  // namespace desert_sim::materials
