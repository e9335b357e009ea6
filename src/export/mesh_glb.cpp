/// Binary glTF files.
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/core/temporary_file.hpp"
#include "src/export/mesh_files.hpp"

namespace desert_sim {

namespace {

/// Colours of vertices are linear in glTF; ours are those of a display (sRGB).
std::array<std::uint16_t, 256> linear_colours() {
  std::array<std::uint16_t, 256> linear{};
  for (std::size_t n = 0; n < linear.size(); ++n) {
    const double c = static_cast<double>(n) / 255;
    const double value = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    linear[n] = static_cast<std::uint16_t>(std::lround(65535 * value));
  }
  return linear;
}

class GlbScene {
 public:
  explicit GlbScene(const std::string& note) {
    model_.asset.version = "2.0";
    model_.asset.generator = note;
    model_.buffers.emplace_back();
    model_.scenes.emplace_back();
    model_.defaultScene = 0;
  }

  void add(const std::string& name, const render::Mesh& mesh, bool transparent) {
    if (mesh.empty()) return;
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = add_material(name, transparent);
    primitive.attributes["POSITION"] = add_positions(mesh);
    primitive.attributes["NORMAL"] = add_normals(mesh);
    primitive.attributes["COLOR_0"] = add_colours(mesh);
    primitive.indices = add_view(mesh.indices, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                                 {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, 1});
    tinygltf::Mesh added;
    added.name = name;
    added.primitives.push_back(primitive);
    tinygltf::Node node;
    node.name = name;
    node.mesh = index_of_next(model_.meshes);
    model_.meshes.push_back(added);
    model_.scenes[0].nodes.push_back(index_of_next(model_.nodes));
    model_.nodes.push_back(node);
  }

  double bytes() const { return static_cast<double>(model_.buffers[0].data.size()); }
  const tinygltf::Model& model() const { return model_; }

 private:
  struct Elements {
    int component, type;
    std::size_t components;
    bool normalized = false;
  };

  template <class Items>
  static int index_of_next(const Items& items) {
    return static_cast<int>(items.size());
  }

  int add_material(const std::string& name, bool transparent) {
    tinygltf::Material material;
    material.name = name;
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = transparent ? 0.1 : 1;
    if (transparent) material.alphaMode = "BLEND";
    model_.materials.push_back(material);
    return index_of_next(model_.materials) - 1;
  }

  int add_positions(const render::Mesh& mesh) {
    std::vector<float> numbers;
    numbers.reserve(3 * mesh.vertices.size());
    for (const render::Vertex& v : mesh.vertices) numbers.insert(numbers.end(), {v.x, v.z, -v.y});
    const int accessor = add_view(numbers, TINYGLTF_TARGET_ARRAY_BUFFER,
                                  {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, 3});
    std::vector<double> low(3, std::numeric_limits<double>::infinity()), high(3, -low[0]);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      low[n % 3] = std::min(low[n % 3], static_cast<double>(numbers[n]));
      high[n % 3] = std::max(high[n % 3], static_cast<double>(numbers[n]));
    }
    model_.accessors.back().minValues = low;
    model_.accessors.back().maxValues = high;
    return accessor;
  }

  int add_normals(const render::Mesh& mesh) {
    std::vector<float> numbers;
    numbers.reserve(3 * mesh.vertices.size());
    for (const render::Vertex& v : mesh.vertices)
      numbers.insert(numbers.end(), {v.normal_x, v.normal_z, -v.normal_y});
    return add_view(numbers, TINYGLTF_TARGET_ARRAY_BUFFER,
                    {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, 3});
  }

  int add_colours(const render::Mesh& mesh) {
    static const std::array<std::uint16_t, 256> linear = linear_colours();
    std::vector<std::uint16_t> numbers;
    numbers.reserve(4 * mesh.vertices.size());
    for (const render::Vertex& v : mesh.vertices) {
      for (int shift = 0; shift < 24; shift += 8) numbers.push_back(linear[v.colour >> shift & 255]);
      numbers.push_back(static_cast<std::uint16_t>(257 * (v.colour >> 24)));
    }
    return add_view(numbers, TINYGLTF_TARGET_ARRAY_BUFFER,
                    {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4, 4, true});
  }

  /// Appends numbers to the buffer, with a view and an accessor; returns the accessor. All have whole
  /// multiples of four bytes, as their alignment wants it.
  template <class Number>
  int add_view(const std::vector<Number>& numbers, int target, const Elements& elements) {
    std::vector<unsigned char>& data = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = numbers.size() * sizeof(Number);
    view.target = target;
    const auto* const bytes = reinterpret_cast<const unsigned char*>(numbers.data());
    data.insert(data.end(), bytes, bytes + view.byteLength);
    tinygltf::Accessor accessor;
    accessor.bufferView = index_of_next(model_.bufferViews);
    accessor.componentType = elements.component;
    accessor.normalized = elements.normalized;
    accessor.type = elements.type;
    accessor.count = numbers.size() / elements.components;
    model_.bufferViews.push_back(view);
    model_.accessors.push_back(accessor);
    return index_of_next(model_.accessors) - 1;
  }

  tinygltf::Model model_;
};

}  // namespace

void write_glb(const std::string& path, const ExportedTerrain& terrain) {
  constexpr double most_bytes = 4294967295.0, of_the_text = 1 << 16;
  const TerrainMeshes meshes = meshes_of(path, terrain);
  GlbScene scene(frame_note(*terrain.snapshot) + ", x is east, y is up, -z is north");
  scene.add("ground", meshes.ground, false);
  scene.add("water", meshes.water, true);
  scene.add("plants", meshes.plants, false);
  if (scene.bytes() + of_the_text > most_bytes)
    throw ConfigError(path + ": a .glb has at most 4 GiB, and this terrain needs " +
                      number_text(scene.bytes() / (1 << 30)) + " (allowed: .ply, .stl or .obj)");
  if (terrain.after_piece) terrain.after_piece();  // the scene; what follows is one call
  TemporaryFile file(path);
  std::ofstream stream(file.library_path(), std::ios::binary);
  tinygltf::TinyGLTF writer;
  const bool written = writer.WriteGltfSceneToStream(&scene.model(), stream, false, true);
  stream.close();
  if (!written || !stream) throw WriteError(path + ": cannot be written: the disk is full or broken");
  file.publish();
}

}  // namespace desert_sim
