/// The scene as plain data: structs and indices, no pointers between them. A Scene can be copied (cheaply:
/// arrays are shared), compared, edited and written back. It follows glTF 2.0: right-handed, y up, metres,
/// radians, linear Rec.709 colours, cameras and lights looking along -z.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/base/shared_array.h"
#include "renderer/scene/image.h"

namespace parian {

/// Where an index may be absent.
inline constexpr int kNone = -1;

enum class Wrap : std::uint8_t { repeat, mirrored_repeat, clamp_to_edge };
enum class Filter : std::uint8_t { nearest, linear };

/// An image with its sampler.
struct Texture {
  int image = kNone;
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  Filter filter = Filter::linear;
  Origin origin = {};
  bool operator==(const Texture&) const = default;
};

/// One use of a texture by a material.
struct TextureRef {
  int texture = kNone;
  int uv_set = 0;  // 0 or 1
  // KHR_texture_transform as an affine map: u' = a u + b v + c; v' = d u + e v + f.
  std::array<float, 6> transform{1, 0, 0, 0, 1, 0};
  bool operator==(const TextureRef&) const = default;
  explicit operator bool() const { return texture != kNone; }
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// What a material may have beyond metallic-roughness, each named for its extension. Absent: the scene does
/// not ask for it. Colours are linear; a texture multiplies its factor.

/// KHR_materials_transmission: light that passes a dielectric surface instead of meeting its diffuse base.
struct Transmission {
  float factor = 0;
  TextureRef texture;  // linear, in R
  bool operator==(const Transmission&) const = default;
};

/// KHR_materials_volume. The surface bounds a homogeneous volume where thickness is above 0 or the volume
/// scatters, and is thin-walled otherwise.
struct Volume {
  float thickness = 0;
  Rgb attenuation_color{1, 1, 1};
  float attenuation_distance = 0;  // metres after which white light has the colour; 0: no attenuation
  bool operator==(const Volume&) const = default;
};

/// KHR_materials_volume_scatter: the attenuation of the volume is by scattering too.
struct VolumeScatter {
  Rgb multiscatter_color{0, 0, 0};  // what a thick body of it reflects, in [0, 1]
  float anisotropy = 0;             // mean cosine of a scattering, in (-1, 1)
  bool operator==(const VolumeScatter&) const = default;
};

/// KHR_materials_diffuse_transmission.
struct DiffuseTransmission {
  float factor = 0;
  Rgb color{1, 1, 1};
  TextureRef texture;        // linear, in A
  TextureRef color_texture;  // sRGB
  bool operator==(const DiffuseTransmission&) const = default;
};

/// KHR_materials_clearcoat.
struct Clearcoat {
  float factor = 0, roughness = 0;
  TextureRef texture;            // linear, in R
  TextureRef roughness_texture;  // linear, in G
  TextureRef normal_texture;
  float normal_scale = 1;
  bool operator==(const Clearcoat&) const = default;
};

/// KHR_materials_sheen.
struct SheenModel {
  Rgb color{0, 0, 0};
  float roughness = 0;
  TextureRef color_texture;      // sRGB
  TextureRef roughness_texture;  // linear, in A
  bool operator==(const SheenModel&) const = default;
};

/// KHR_materials_anisotropy.
struct Anisotropy {
  float strength = 0;  // in [0, 1]
  float rotation = 0;  // radians, counter-clockwise from the tangent
  TextureRef texture;  // linear: direction in RG, strength in B
  bool operator==(const Anisotropy&) const = default;
};

/// KHR_materials_iridescence: a thin film.
struct Iridescence {
  float factor = 0, ior = 1.3f;
  float thickness_minimum = 100, thickness_maximum = 400;  // nanometres; without texture the maximum
  TextureRef texture;                                      // linear, in R
  TextureRef thickness_texture;                            // linear, in G
  bool operator==(const Iridescence&) const = default;
};

/// PARIAN_materials_phong: a Lambert base and the normalised Phong lobe, in place of metallic-roughness.
struct PhongModel {
  Rgb diffuse{0, 0, 0}, specular{1, 1, 1};
  float exponent = 1;
  bool operator==(const PhongModel&) const = default;
};

/// PARIAN_materials_conductor: a metal of complex index of refraction eta + i k, in place of
/// metallic-roughness. Its roughness is the material's; 0 is a mirror.
struct ConductorModel {
  Rgb eta{1, 1, 1}, k{0, 0, 0};
  bool operator==(const ConductorModel&) const = default;
};

/// PARIAN_materials_subsurface: a body that scatters light below an interface of the material's ior and
/// roughness, in place of metallic-roughness. Per metre.
struct SubsurfaceModel {
  Rgb absorption{0, 0, 0}, reduced_scattering{0, 0, 0};
  bool operator==(const SubsurfaceModel&) const = default;
};

/// glTF's metallic-roughness material with its extensions. Colours are linear; a texture multiplies its
/// factor.
struct Material {
  std::string name;
  Rgb base_color{1, 1, 1};
  float alpha = 1;
  TextureRef base_color_texture;  // sRGB colour, linear alpha
  float metallic = 1, roughness = 1;
  TextureRef metallic_roughness_texture;  // linear: roughness in G, metallic in B
  TextureRef normal_texture;              // linear, tangent space
  float normal_scale = 1;
  Rgb emission{0, 0, 0};        // radiance: emissiveFactor times emissiveStrength
  TextureRef emission_texture;  // sRGB
  float ior = 1.5f;             // KHR_materials_ior; 0 means infinite (F0 = 1)
  float specular = 1;           // KHR_materials_specular; 0 leaves a pure Lambert surface
  Rgb specular_color{1, 1, 1};
  TextureRef specular_texture;        // linear, in A
  TextureRef specular_color_texture;  // sRGB
  std::optional<Transmission> transmission;
  std::optional<Volume> volume;
  std::optional<VolumeScatter> scatter;  // of the volume
  std::optional<DiffuseTransmission> diffuse_transmission;
  std::optional<Clearcoat> clearcoat;
  std::optional<SheenModel> sheen;
  std::optional<Anisotropy> anisotropy;
  std::optional<Iridescence> iridescence;
  std::optional<PhongModel> phong;  // at most one of phong, conductor and subsurface
  std::optional<ConductorModel> conductor;
  std::optional<SubsurfaceModel> subsurface;
  float dispersion = 0;  // KHR_materials_dispersion: 20 over the Abbe number; of a volume
  int priority = 0;      // PARIAN_materials_priority: where volumes overlap, the highest is there
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;  // KHR_materials_unlit: base colour is what is seen, no light transport

  /// Whether its surface bounds a volume that light enters.
  bool has_interior() const {
    if (subsurface) return true;
    return volume && (volume->thickness > 0 || scatter) && (transmission || diffuse_transmission);
  }
  /// Whether what it emits depends on place or direction.
  bool emission_varies() const { return emission_texture || clearcoat; }
  Origin origin = {};
  bool operator==(const Material&) const = default;
};

/// Calls visit(texture) for every use of a texture that a material (const or not) can have, set or not.
template <class AnyMaterial, class Visit>
void for_each_texture(AnyMaterial& m, const Visit& visit) {
  for (auto* t : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                  &m.emission_texture, &m.specular_texture, &m.specular_color_texture})
    visit(*t);
  if (m.transmission) visit(m.transmission->texture);
  if (m.diffuse_transmission)
    for (auto* t : {&m.diffuse_transmission->texture, &m.diffuse_transmission->color_texture}) visit(*t);
  if (m.clearcoat)
    for (auto* t : {&m.clearcoat->texture, &m.clearcoat->roughness_texture, &m.clearcoat->normal_texture})
      visit(*t);
  if (m.sheen)
    for (auto* t : {&m.sheen->color_texture, &m.sheen->roughness_texture}) visit(*t);
  if (m.anisotropy) visit(m.anisotropy->texture);
  if (m.iridescence)
    for (auto* t : {&m.iridescence->texture, &m.iridescence->thickness_texture}) visit(*t);
}

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles of one material. Arrays other than positions and triangles may be empty; otherwise they hold one
/// element per vertex. Counter-clockwise is the front.
struct Primitive {
  SharedArray<Vec3f> positions;
  SharedArray<Vec3f> normals;  // unit; empty: flat, from the triangle
  SharedArray<Vec4f>
      tangents;  // xyz unit, w the sign of the bitangent; empty: from the uv set of the normal map
  std::array<SharedArray<Vec2f>, 2> uvs;
  SharedArray<Vec4f> colors;  // linear, multiplies base colour and alpha
  SharedArray<Triangle> triangles;
  int material = kNone;
  Origin origin = {};
  bool operator==(const Primitive&) const = default;
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  Origin origin = {};
  bool operator==(const Mesh&) const = default;
};

enum class ShapeKind : std::uint8_t { sphere, cylinder, box, plane };

/// A shape that needs no mesh (KHR_implicit_shapes), about the origin of the node that shows it; metres.
struct Shape {
  std::string name;
  ShapeKind kind = ShapeKind::sphere;
  float radius = 0.5f;  // sphere
  // Cylinder: capped, along y, its bottom at -height / 2; where the radii differ a frustum, where one is 0 a
  // cone.
  float radius_bottom = 0.25f, radius_top = 0.25f, height = 0.5f;
  Vec3f size{1, 1, 1};  // box: full sides; plane: its sides along x and z, its front towards +y
  Origin origin = {};
  bool operator==(const Shape&) const = default;
};

/// EXT_camera_physical. The lens is a disk of radius focal_length / (2 f_stop), focused on the plane at
/// focus_distance; metres.
struct Lens {
  float focal_length = 0.05f, f_stop = 2.8f, focus_distance = 1;
  std::array<float, 2> sensor_size{0.036f, 0.024f};
  bool operator==(const Lens&) const = default;
};

enum class Projection : std::uint8_t { perspective, orthographic };

struct Camera {
  std::string name;
  Projection projection = Projection::perspective;
  float yfov = 0.8f;         // perspective: full vertical angle
  float aspect = 0;          // perspective: width / height; 0: that of the image
  float xmag = 1, ymag = 1;  // orthographic: half width and half height
  float znear = 0.01f,
        zfar = 0;            // kept for other viewers: a ray tracer has no depth buffer and clips nothing
  std::optional<Lens> lens;  // absent: a pinhole
  Origin origin = {};
  bool operator==(const Camera&) const = default;
};

enum class LightKind : std::uint8_t { point, spot, directional, rectangle, disk };

/// A light without a mesh. It sits at its node's origin and shines along -z (all kinds but point).
struct Light {
  std::string name;
  LightKind kind = LightKind::point;
  Rgb color{1, 1, 1};
  float intensity = 1;  // point, spot: W/sr; directional: W/m^2; rectangle, disk: radiance, from the -z side
  float range = 0;      // punctual: glTF's cut-off distance; 0: none
  float inner_angle = 0, outer_angle = kPi / 4;  // spot: half angles
  float width = 1, height = 1;                   // rectangle: full sides; disk: width is the diameter
  Origin origin = {};
  bool operator==(const Light&) const = default;
};

/// Translation, rotation, scale; or a matrix where the file gives one.
struct Transform {
  Vec3f translation{0, 0, 0};
  Quatf rotation{1, 0, 0, 0};
  Vec3f scale{1, 1, 1};
  std::optional<Imath::M44f> matrix;
  Mat4d to_matrix() const;
  bool operator==(const Transform&) const = default;
};

/// Where an instance is, of millions: a transform without matrix.
struct InstanceTransform {
  Vec3f translation{0, 0, 0};
  Quatf rotation{1, 0, 0, 0};
  Vec3f scale{1, 1, 1};
  Mat4d to_matrix() const;
  bool operator==(const InstanceTransform&) const = default;
};

struct Node {
  std::string name;
  Transform transform;
  std::vector<int> children;
  int mesh = kNone, camera = kNone, light = kNone;
  int shape = kNone, shape_material = kNone;  // PARIAN_shape: both, or neither
  SharedArray<InstanceTransform>
      instances;        // EXT_mesh_gpu_instancing: if not empty, mesh and shape are drawn once for each
  bool visible = true;  // KHR_node_visibility: if not, no mesh, shape or light of it and below is there
  Origin origin = {};
  bool operator==(const Node&) const = default;
};

/// What a ray that hits nothing sees: radiance, times an equirectangular image where there is one.
/// Image u grows with the angle from -x over -z, +x, +z (EXT_lights_environment: the centre is +x), top row
/// is +y.
struct Environment {
  Rgb radiance{0, 0, 0};
  int image = kNone;
  Quatf rotation{1, 0, 0, 0};  // turns the environment: world direction = rotation (environment direction)
  Origin origin = {};
  bool operator==(const Environment&) const = default;
};

struct Scene {
  std::vector<Node> nodes;
  std::vector<int> roots;
  std::vector<Mesh> meshes;
  std::vector<Shape> shapes;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Image> images;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  Environment environment;
  bool operator==(const Scene&) const = default;
};

/// Adds the content of `other` to `scene`, its indices shifted. An environment replaces one that is black.
void append(Scene& scene, const Scene& other);

/// Checks what the renderer relies on: every index in range (a primitive's material included), the node graph
/// a forest, arrays of matching length, numbers finite and in range. Throws InputError naming `file` and the
/// place, as a path like /meshes/2/primitives/0/triangles/17.
void validate(const Scene& scene, const std::string& file);

}  // namespace parian
