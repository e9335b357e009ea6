#pragma once
/// OGRE materials of the plugins. Their light is computed for each vertex and without shaders, which is what software
/// rasterisers are fast at.

#include <OgreMaterial.h>

namespace desert_sim::materials {

/// Lit, in the colours of the vertices. Lies a little behind its place, so that lines on it are seen.
Ogre::MaterialPtr ground();
/// Lit and translucent by the alpha of the vertices.
Ogre::MaterialPtr water();
/// Unlit and translucent by the alpha of the vertices.
Ogre::MaterialPtr lines();
/// Lit, in the colours of the vertices.
Ogre::MaterialPtr shapes();

}  // namespace desert_sim::materials
