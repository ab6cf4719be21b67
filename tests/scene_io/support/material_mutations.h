/// What breaks the materials' extensions of a document.
#pragma once

#include <string>
#include <vector>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {

/// Where, the value put there, and the start of the message where that is not the place itself.
struct Mutation {
  std::string place;
  json value;
  std::string expected = {};
};

inline const json kRemoved = "removed";

/// For the document of gltf_broken_test.cpp.
inline std::vector<Mutation> material_extension_mutations() {
  const std::string khronos = "/materials/1/extensions/KHR_materials_";
  const std::string ours = "/materials/1/extensions/PARIAN_materials_";
  const std::string eta_k = "/materials/2/extensions/PARIAN_materials_conductor";
  const std::string named = "/materials/3/extensions/PARIAN_materials_conductor";
  const std::string marble = "/materials/5/extensions/PARIAN_materials_subsurface";
  const std::string sigma = "/materials/4/extensions/PARIAN_materials_subsurface";
  return {
      {khronos + "transmission", 1},
      {khronos + "transmission/transmissionFactor", 1.1},
      {khronos + "transmission/transmissionTexture/index", 1},
      {khronos + "volume/thicknessFactor", -1},
      {khronos + "volume/thicknessTexture/index", 1},
      {khronos + "volume/attenuationDistance", 0},
      {khronos + "volume/attenuationColor/2", 1.5},
      {khronos + "volume/attenuationColor", {1, 1}},
      {khronos + "volume", kRemoved,
       khronos + "volume_scatter: expected no such member without KHR_materials_volume"},
      {khronos + "volume_scatter", 1},
      {khronos + "volume_scatter/multiscatterColor/1", 1.1},
      {khronos + "volume_scatter/multiscatterColor/2", -0.1},
      {khronos + "volume_scatter/multiscatterColor", {1, 1}},
      {khronos + "volume_scatter/scatterAnisotropy", 1},
      {khronos + "volume_scatter/scatterAnisotropy", -1},
      {khronos + "volume_scatter/scatterAnisotropy", 0.999999999},  // 1 as a float
      {khronos + "volume_scatter/scatterAnisotropy", "0"},
      {khronos + "dispersion/dispersion", -0.1},
      {khronos + "diffuse_transmission/diffuseTransmissionFactor", -0.1},
      {khronos + "diffuse_transmission/diffuseTransmissionTexture/index", kRemoved},
      {khronos + "diffuse_transmission/diffuseTransmissionColorFactor/0", 2},
      {khronos + "diffuse_transmission/diffuseTransmissionColorTexture/texCoord", -1},
      {khronos + "clearcoat/clearcoatFactor", 2},
      {khronos + "clearcoat/clearcoatTexture", 0},
      {khronos + "clearcoat/clearcoatRoughnessFactor", "rough"},
      {khronos + "clearcoat/clearcoatRoughnessTexture/index", 9},
      {khronos + "clearcoat/clearcoatNormalTexture/index", 9},
      {khronos + "clearcoat/clearcoatNormalTexture/scale", nullptr},
      {khronos + "sheen/sheenColorFactor/1", -1},
      {khronos + "sheen/sheenColorTexture/index", 9},
      {khronos + "sheen/sheenRoughnessFactor", 1.5},
      {khronos + "sheen/sheenRoughnessTexture/index", 9},
      {khronos + "anisotropy/anisotropyStrength", 1.5},
      {khronos + "anisotropy/anisotropyRotation", 1e39},
      {khronos + "anisotropy/anisotropyTexture/index", 9},
      {khronos + "iridescence/iridescenceFactor", -1},
      {khronos + "iridescence/iridescenceTexture/index", 9},
      {khronos + "iridescence/iridescenceIor", 0.9},
      {khronos + "iridescence/iridescenceThicknessMinimum", -1},
      {khronos + "iridescence/iridescenceThicknessMaximum", -1},
      {khronos + "iridescence/iridescenceThicknessTexture/index", 9},
      {ours + "phong/diffuse", kRemoved},
      {ours + "phong/diffuse/0", 1.1},
      {ours + "phong/specular", kRemoved},
      {ours + "phong/specular/2", -0.1},
      {ours + "phong/exponent", kRemoved},
      {ours + "phong/exponent", -1},
      {ours + "priority/priority", 0.5},
      {ours + "priority/priority", "1"},
      {ours + "priority/priority", 2147483648},
      {ours + "conductor",
       {{"name", "gold"}},
       ours + "phong: expected no such member beside PARIAN_materials_conductor"},
      {eta_k + "/eta", kRemoved, eta_k + "/eta: expected 3 numbers, each of at least 0, since there is no"},
      {eta_k + "/k", kRemoved},
      {eta_k + "/eta/1", -1},
      {eta_k + "/k/1", 1e39},
      {eta_k + "/name", "gold", eta_k + "/eta: expected no such member, since name says"},
      {named + "/k", {1, 1, 1}, named + "/k: expected no such member, since name says"},
      {named + "/name", kRemoved, named + "/eta"},
      {named + "/name", "cheese", named + "/name: expected one of \"silver\", \"gold\", \"copper\", "},
      {sigma + "/sigmaA", kRemoved,
       sigma + "/sigmaA: expected 3 numbers, each of at least 0, since there is no"},
      {sigma + "/sigmaSPrime", kRemoved},
      {sigma + "/sigmaA/0", -0.1},
      {sigma + "/sigmaA/2", 2e9},
      {sigma + "/sigmaA", {1, 1}},
      {sigma + "/sigmaSPrime/1", -1},
      {sigma + "/sigmaSPrime/1", 2e9},
      {sigma + "/sigmaSPrime/1", "1"},
      {sigma + "/eta", 0.9},
      {sigma + "/eta", 1e39},
      {sigma + "/scale", 0},
      {sigma + "/scale", -1},
      {sigma + "/scale", 1e10},
      {sigma + "/name", "marble", sigma + "/sigmaA: expected no such member, since name says"},
      {marble + "/sigmaA", {1, 1, 1}, marble + "/sigmaA: expected no such member, since name says"},
      {marble + "/sigmaSPrime", {1, 1, 1}, marble + "/sigmaSPrime: expected no such member, since name says"},
      {marble + "/eta", 1.5, marble + "/eta: expected no such member, since name says"},
      {marble + "/name", kRemoved, marble + "/sigmaA"},
      {marble + "/name", "cheese", marble + "/name: expected one of \"apple\", \"chicken1\", "},
      {sigma + "/color", {1, 1, 1}, sigma + "/meanFreePath: expected 3 numbers, since color and"},
      {sigma + "/meanFreePath", {1, 1, 1}, sigma + "/color: expected 3 numbers, since color and"},
      {sigma, {{"color", {1, 1, 2}}, {"meanFreePath", {1, 1, 1}}}, sigma + "/color/2"},
      {sigma, {{"color", {1, 1, 1}}, {"meanFreePath", {1, 0, 1}}}, sigma + "/meanFreePath/1"},
      {sigma,
       {{"color", {1, 1, 1}}, {"meanFreePath", {1, 1, 1}}, {"sigmaA", {1, 1, 1}}},
       sigma + "/sigmaA: expected no such member beside color"},
      {ours + "subsurface",
       {{"name", "marble"}},
       ours + "subsurface: expected no such member beside PARIAN_materials_phong"},
      {"/materials/3/extensions/PARIAN_materials_subsurface",
       {{"name", "marble"}},
       "/materials/3/extensions/PARIAN_materials_subsurface: expected no such member beside "
       "PARIAN_materials_conductor"},
      {"/materials/5/extensions",
       {{"PARIAN_materials_subsurface", {{"name", "marble"}}},
        {"KHR_materials_volume", json::object()},
        {"KHR_materials_volume_scatter", json::object()}},
       marble + ": expected no such member beside KHR_materials_volume_scatter"},
  };
}

}  // namespace parian
