#include "scene_io/gltf/pose/animation.h"

#include <set>
#include <string>

#include "scene_io/gltf/pose/keyframes.h"
#include "scene_io/gltf/read.h"

namespace parian {
namespace {

Interpolation to_interpolation(const std::string& name) {
  if (name == "STEP") return Interpolation::step;
  return name == "CUBICSPLINE" ? Interpolation::cubic_spline : Interpolation::linear;
}

class PoseReader {
 public:
  PoseReader(const GltfDocument& document, AccessorReader& accessors, double seconds)
      : document_(document), accessors_(accessors), seconds_(seconds) {}

  Pose read() {
    for (std::size_t a = 0; a < document_.model.animations.size(); ++a) {
      const auto& animation = document_.model.animations[a];
      for (std::size_t c = 0; c < animation.channels.size(); ++c) {
        if (animation.channels[c].target_node < 0) continue;  // for an extension's eyes
        read_channel(animation, animation.channels[c], fmt::format("/animations/{}", a), c);
      }
    }
    return std::move(pose_);
  }

 private:
  void read_channel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel,
                    const std::string& where, std::size_t number) {
    const std::string& path = channel.target_path;
    const std::string target = fmt::format("{}/channels/{}/target/node", where, number);
    const auto& node = document_.model.nodes[std::size_t(channel.target_node)];
    const std::size_t targets = path == "weights" ? morph_target_count(document_, node.mesh) : 0;
    if (path == "weights" && targets == 0)
      document_.fail(target, "expected a node whose mesh has morph targets");
    if (path != "weights" && !node.matrix.empty()) document_.fail(target, "expected a node without a matrix");
    const Keyframes keys = read_keys(animation.samplers[std::size_t(channel.sampler)], path, targets,
                                     fmt::format("{}/samplers/{}", where, channel.sampler));
    accessors_.claim(keys.width * sizeof(float), target);
    std::vector<float> value = sample(keys, seconds_);
    NodePose& posed = pose_[channel.target_node];
    if (path == "weights") {
      posed.weights = std::move(value);
    } else if (path == "rotation") {
      if (value == std::vector<float>(4)) {
        document_.fail(fmt::format("{}/samplers/{}/output", where, channel.sampler),
                       fmt::format("expected a rotation at {} s, not zero", seconds_));
      }
      posed.rotation = Quatf(value[3], value[0], value[1], value[2]);
    } else {
      (path == "scale" ? posed.scale : posed.translation) = Vec3f(value[0], value[1], value[2]);
    }
  }

  /// `targets`: how many weights a value has; 0: it has none.
  Keyframes read_keys(const tinygltf::AnimationSampler& sampler, const std::string& path, std::size_t targets,
                      const std::string& where) {
    const std::size_t width = targets > 0 ? targets : path == "rotation" ? 4 : 3;
    const int type = targets > 0  ? TINYGLTF_TYPE_SCALAR
                     : width == 4 ? TINYGLTF_TYPE_VEC4
                                  : TINYGLTF_TYPE_VEC3;
    const Components components{.normalized_integers = width == 4 || targets > 0};
    Keyframes keys{.interpolation = to_interpolation(sampler.interpolation),
                   .rotation = path == "rotation",
                   .width = width,
                   .times = read_times(sampler.input, where + "/input"),
                   .values = accessors_.numbers(sampler.output, type, components, where + "/output")};
    check_counts(keys, targets > 0 ? 1 : width, where);
    return keys;
  }

  SharedArray<float> read_times(int accessor, const std::string& where) {
    SharedArray<float> times = accessors_.numbers(accessor, TINYGLTF_TYPE_SCALAR, {}, where);
    if (!checked_times_.insert(accessor).second) return times;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (i == 0 ? times[0] < 0 : times[i] <= times[i - 1]) {
        document_.fail(fmt::format("/accessors/{}", accessor),
                       fmt::format("expected rising times of at least 0, since {} says that it holds times; "
                                   "element {} is {}",
                                   where, i, times[i]));
      }
    }
    return times;
  }

  /// `components`: how many numbers an element of the output is.
  void check_counts(const Keyframes& keys, std::size_t components, const std::string& where) const {
    const bool spline = keys.interpolation == Interpolation::cubic_spline;
    if (spline && keys.times.size() < 2)
      document_.fail(where + "/input", "expected at least 2 times for CUBICSPLINE");
    const std::size_t expected = keys.times.size() * (spline ? 3 : 1) * keys.width;
    if (keys.values.size() == expected) return;
    document_.fail(where + "/output",
                   fmt::format("expected {} elements for {} times, not {}", expected / components,
                               keys.times.size(), keys.values.size() / components));
  }

  const GltfDocument& document_;
  AccessorReader& accessors_;
  double seconds_;
  Pose pose_;
  std::set<int> checked_times_;  // many samplers share one accessor
};

}  // namespace

Pose read_pose(const GltfDocument& document, AccessorReader& accessors, double seconds) {
  return PoseReader(document, accessors, seconds).read();
}

}  // namespace parian
