#include "scene_io/gltf/file/schema.h"

#include <utility>

namespace parian {
namespace {

constexpr double kMaxInt = 2147483647;  // what tinygltf holds in an int
constexpr double kHalfPi = 1.5707964;   // the float above pi / 2
constexpr double kBelowPi = 3.1415925;

Field accessors() {
  return list("accessors",
              {index("bufferView", "/bufferViews"), integer("byteOffset"),
               choice("componentType", {5120, 5121, 5122, 5123, 5125, 5126}).required(), flag("normalized"),
               integer("count").at_least(1).required(),
               text("type", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}).required(),
               object("sparse", {integer("count").between(1, kMaxInt).required(),
                                 object("indices", {index("bufferView", "/bufferViews").required(),
                                                    integer("byteOffset").between(0, kMaxInt),
                                                    choice("componentType", {5121, 5123, 5125}).required()})
                                     .required(),
                                 object("values", {index("bufferView", "/bufferViews").required(),
                                                   integer("byteOffset").between(0, kMaxInt)})
                                     .required()})});
}

Field buffer_views() {
  return list("bufferViews",
              {index("buffer", "/buffers").required(), integer("byteOffset"),
               integer("byteLength").at_least(1).required(), integer("byteStride").between(4, 252),
               object("extensions",
                      {object("EXT_meshopt_compression",
                              {index("buffer", "/buffers").required(), integer("byteOffset"),
                               integer("byteLength").at_least(1).required(),
                               integer("byteStride").between(1, 256).required(),
                               integer("count").between(1, kMaxInt).required(),
                               text("mode", {"ATTRIBUTES", "TRIANGLES", "INDICES"}).required(),
                               text("filter", {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"})})})});
}

Field buffers() {
  return list("buffers", {text("uri"), integer("byteLength").at_least(1).required(),
                          object("extensions", {object("EXT_meshopt_compression", {flag("fallback")})})});
}

Field cameras() {
  return list(
      "cameras",
      {text("name"), text("type", {"perspective", "orthographic"}).required(),
       object("perspective",
              {number("yfov").between(1e-6, kBelowPi).required(), number("aspectRatio").positive(),
               number("znear").positive().required(), number("zfar").positive()}),
       object("orthographic", {number("xmag").positive().required(), number("ymag").positive().required(),
                               number("znear").at_least(0).required(), number("zfar").positive().required()}),
       object("extensions", {object("EXT_camera_physical",
                                    {number("focalLength").positive().required(),
                                     numbers("sensorSize", 2).positive().required(),
                                     number("fStop").positive(), number("focusDistance").at_least(0)})})});
}

Field draco() {
  return object("KHR_draco_mesh_compression", {index("bufferView", "/bufferViews").required(),
                                               integer_map("attributes").between(0, kMaxInt).required()});
}

Field meshes() {
  return list(
      "meshes",
      {text("name"),
       list("primitives", {index_map("attributes", "/accessors").required(), index("indices", "/accessors"),
                           index("material", "/materials"), choice("mode", {0, 1, 2, 3, 4, 5, 6}),
                           index_maps("targets", "/accessors"), object("extensions", {draco()})})
           .required(),
       numbers("weights", kAnyCount)});
}

Field nodes() {
  return list(
      "nodes",
      {text("name"), indices("children", "/nodes"), index("mesh", "/meshes"), index("camera", "/cameras"),
       index("skin", "/skins"), numbers("weights", kAnyCount), numbers("matrix", 16),
       numbers("translation", 3), numbers("rotation", 4), numbers("scale", 3),
       object("extensions",
              {object("KHR_lights_punctual",
                      {index("light", "/extensions/KHR_lights_punctual/lights").required()}),
               object("EXT_lights_area", {index("light", "/extensions/EXT_lights_area/lights").required()}),
               object("EXT_mesh_gpu_instancing", {index_map("attributes", "/accessors").required()}),
               object("KHR_node_visibility", {flag("visible")}),
               object("PARIAN_shape", {index("shape", "/extensions/KHR_implicit_shapes/shapes").required(),
                                       index("material", "/materials")})})});
}

/// The parameters of a cylinder or a capsule.
Field tapered(std::string key) {
  return object(std::move(key), {number("height").positive(), number("radiusBottom").at_least(0),
                                 number("radiusTop").at_least(0)});
}

/// Of any type: a shape may be there for another extension's use, and of a type that comes from one.
Field shapes() {
  return list(
      "shapes",
      {text("name"), text("type").required(), object("sphere", {number("radius").positive()}),
       object("box", {numbers("size", 3).positive()}), tapered("cylinder"), tapered("capsule"),
       object("plane", {number("sizeX").positive(), number("sizeZ").positive(), flag("doubleSided")})});
}

Field document_extensions() {
  return object(
      "extensions",
      {object("KHR_lights_punctual",
              {list("lights", {text("name"), text("type", {"point", "spot", "directional"}).required(),
                               numbers("color", 3).at_least(0), number("intensity").at_least(0),
                               number("range").positive(),
                               object("spot", {number("innerConeAngle").between(0, kHalfPi),
                                               number("outerConeAngle").between(0, kHalfPi)})})
                   .required()}),
       object("EXT_lights_area",
              {list("lights", {text("name"), text("type", {"rect", "disk"}).required(),
                               numbers("color", 3).at_least(0), number("intensity").at_least(0),
                               number("size").positive(), object("rect", {number("aspect").positive()})})
                   .required()}),
       object("EXT_lights_environment",
              {list("environments", {index("source", "/images").required(), number("intensity").at_least(0),
                                     text("frontside", {"+X", "-X", "+Z", "-Z"})})
                   .required()}),
       object("KHR_implicit_shapes", {shapes().required()})});
}

}  // namespace

std::vector<Field> document_fields() {
  const std::vector<int> wrap = {33071, 33648, 10497};
  return {
      object("asset", {text("version").required(), text("minVersion")}).required(),
      texts("extensionsUsed"),
      texts("extensionsRequired"),
      accessors(),
      animation_fields(),
      buffer_views(),
      buffers(),
      cameras(),
      list("images", {text("name"), text("uri"), index("bufferView", "/bufferViews")}),
      material_fields(),
      meshes(),
      nodes(),
      list("samplers", {choice("magFilter", {9728, 9729}), choice("wrapS", wrap), choice("wrapT", wrap)}),
      skin_fields(),
      list("scenes",
           {text("name"), indices("nodes", "/nodes"),
            object(
                "extensions",
                {object("EXT_lights_environment",
                        {index("environment", "/extensions/EXT_lights_environment/environments").required()}),
                 object("PARIAN_environment",
                        {numbers("radiance", 3).at_least(0), numbers("rotation", 4)})})}),
      index("scene", "/scenes"),
      list("textures", {index("source", "/images"), index("sampler", "/samplers"),
                        object("extensions", {object("EXT_texture_webp", {index("source", "/images")})})}),
      document_extensions(),
  };
}

}  // namespace parian
