#include "mesh_io/gltf_motion.hpp"

#include "mesh_io/gltf_accessor.hpp"

#include <string>

namespace echinus {

namespace {

/// The values of a channel, as many for each key.
class Sampler {
  public:
    /// @param name  of the animation, for sentences
    Sampler(GltfFile& file, const GltfValue& sampler, std::string name)
        : file_(file), input_(file, sampler.member("input")), output_(file, sampler.member("output")),
          is_spline_(sampler.member("interpolation").string() == "CUBICSPLINE"), name_(std::move(name)) {
        input_.require_width(1);
        if (input_.count() == 0) fail("has a channel without keys");
    }

    /// @param make  of the number of an element of the output
    template <typename Value, typename Make>
    void read(std::size_t width, Track<Value>& track, Make&& make) const {
        output_.require_width(width);
        require_values(output_.count() == key_count() * values_per_key());
        start(track);
        for (std::size_t key = 0; key < key_count(); ++key)
            track.values.push_back(make(key * values_per_key() + (is_spline_ ? 1 : 0)));
    }

    /// Weights of morphs: as many for each key as there are targets.
    void read_weights(Track<std::vector<double>>& track) const {
        output_.require_width(1);
        const std::size_t unit = key_count() * values_per_key();
        require_values(output_.count() > 0 && output_.count() % unit == 0);
        start(track);
        const std::size_t target_count = output_.count() / unit;
        for (std::size_t key = 0; key < key_count(); ++key) {
            const std::size_t first = (key * values_per_key() + (is_spline_ ? 1 : 0)) * target_count;
            std::vector<double>& weights = track.values.emplace_back();
            for (std::size_t i = 0; i < target_count; ++i) weights.push_back(output_.number(first + i, 0));
        }
    }

    const GltfAccessor& output() const { return output_; }

  private:
    std::size_t key_count() const { return input_.count(); }
    std::size_t values_per_key() const { return is_spline_ ? 3 : 1; }

    template <typename Value>
    void start(Track<Value>& track) const {
        if (!track.times.empty()) fail("has two channels for the same thing");
        file_.spend(key_count() + output_.count());
        for (std::size_t key = 0; key < key_count(); ++key) track.times.push_back(input_.number(key, 0));
    }
    void require_values(bool are_whole) const {
        if (!are_whole)
            fail("has a channel with " + std::to_string(output_.count()) + " values for " +
                 std::to_string(key_count()) + " keys; export the file again");
    }
    [[noreturn]] void fail(const std::string& what) const {
        file_.source().fail(ErrorCode::InvalidMesh, name_ + " " + what);
    }

    GltfFile& file_;
    GltfAccessor input_, output_;
    bool is_spline_;
    std::string name_;
};

void read_channel(const Sampler& sampler, const std::string& path, NodeMotion& motion) {
    const GltfAccessor& output = sampler.output();
    const auto vector = [&](std::size_t i) { return output.vector(i); };
    if (path == "translation") sampler.read(3, motion.positions, vector);
    if (path == "scale") sampler.read(3, motion.scales, vector);
    if (path == "rotation")
        sampler.read(4, motion.rotations, [&](std::size_t i) {
            return Rotation{output.number(i, 3), output.number(i, 0), output.number(i, 1),
                            output.number(i, 2)};
        });
    if (path == "weights") sampler.read_weights(motion.weights);
}

} // namespace

std::vector<SceneAnimation> read_gltf_animations(GltfFile& file, const SceneFile& scene,
                                                 const std::vector<std::size_t>& numbers) {
    std::vector<SceneAnimation> animations;
    const std::vector<GltfValue> nodes = file.root().member("nodes").elements();
    for (const GltfValue& animation : file.root().member("animations").elements()) {
        SceneAnimation& result = animations.emplace_back();
        result.name = animation.member("name").string();
        const std::vector<GltfValue> samplers = animation.member("samplers").elements();
        for (const GltfValue& channel : animation.member("channels").elements()) {
            const GltfValue target = channel.member("target"), node = target.member("node");
            const std::string path = target.member("path").string();
            const std::size_t number = channel.member("sampler").natural_number();
            if (number >= samplers.size())
                channel.fail("refers to sampler " + std::to_string(number) + ", but there are " +
                             std::to_string(samplers.size()));
            if (!node.exists()) continue; // what an extension moves
            const GltfValue& moved = file.element("nodes", node);
            if (moved.member("matrix").exists() && path != "weights")
                moved.fail("is animated and has a matrix; export it with translation, rotation and scale");
            const std::size_t place = numbers[node.natural_number()];
            if (place >= scene.nodes.size()) continue;
            read_channel(Sampler(file, samplers[number], animation.path()), path, result.nodes[place]);
        }
    }
    return animations;
}

} // namespace echinus
