#include "mesh_io/gltf_animation.hpp"

#include "mesh_io/json_view.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace echinus {

namespace {

constexpr std::size_t kFloat = 5126; // OpenGL's name of the type
constexpr std::size_t kUnsignedByte = 5121, kUnsignedShort = 5123;

constexpr std::size_t kMostSets = 4; // of four bones each; the look-up of a set takes time

class Accessors {
  public:
    explicit Accessors(const JsonView& root) : accessors_(root.member("accessors").elements()) {}

    /// @param reference  the number of an accessor; what does not exist counts as empty
    std::size_t count(const JsonView& reference) const { return number(reference, "count"); }
    std::size_t component_type(const JsonView& reference) const { return number(reference, "componentType"); }
    std::string_view type(const JsonView& reference) const {
        const JsonView* accessor = find(reference);
        return accessor != nullptr ? accessor->member("type").string().value_or("") : "";
    }

  private:
    const JsonView* find(const JsonView& reference) const {
        const auto index = reference.natural_number();
        return index && *index < accessors_.size() ? &accessors_[*index] : nullptr;
    }
    std::size_t number(const JsonView& reference, const char* key) const {
        const JsonView* accessor = find(reference);
        return accessor != nullptr ? accessor->member(key).natural_number().value_or(0) : 0;
    }

    std::vector<JsonView> accessors_;
};

void require_count(const MeshSource& source, const std::string& what, std::size_t found,
                   std::size_t expected) {
    if (found != expected)
        source.fail(ErrorCode::InvalidMesh, what + " has " + std::to_string(found) + " entries, but needs " +
                                                std::to_string(expected) + "; export the file again");
}

std::string name_of_set(const char* attribute, std::size_t set) {
    return std::string(attribute) + "_" + std::to_string(set);
}

void require_whole_primitive(const MeshSource& source, const Accessors& accessors, const JsonView& primitive,
                             const std::string& mesh) {
    const JsonView attributes = primitive.member("attributes");
    const std::size_t vertex_count = accessors.count(attributes.member("POSITION"));
    const auto require = [&](const JsonView& owner, const std::string& key, const std::string& where) {
        const JsonView reference = owner.member(key);
        if (reference.exists())
            require_count(source, key + " of " + where + mesh, accessors.count(reference), vertex_count);
    };
    for (std::size_t set = 0;; ++set) {
        const std::string joints = name_of_set("JOINTS", set), weights = name_of_set("WEIGHTS", set);
        const bool has_joints = attributes.member(joints).exists();
        if (has_joints != attributes.member(weights).exists())
            source.fail(ErrorCode::InvalidMesh, mesh + " has " + (has_joints ? joints : weights) +
                                                    " without " + (has_joints ? weights : joints) +
                                                    "; export the file again");
        if (!has_joints) break;
        if (set == kMostSets)
            source.fail(ErrorCode::WrongFormat,
                        mesh + " has more than 16 bones for a vertex; export it with at most four");
        require(attributes, joints, "");
        require(attributes, weights, "");
    }
    const std::vector<JsonView> targets = primitive.member("targets").elements();
    for (std::size_t target = 0; target < targets.size(); ++target)
        for (const char* key : {"POSITION", "NORMAL", "TANGENT"})
            require(targets[target], key, "morph target " + std::to_string(target) + " of ");
}

void require_whole_skin(const MeshSource& source, const Accessors& accessors, const JsonView& skin,
                        const std::string& name) {
    const JsonView matrices = skin.member("inverseBindMatrices");
    if (!matrices.exists())
        source.fail(ErrorCode::WrongFormat,
                    name + " has no inverseBindMatrices, without which it is not read; export the file with "
                           "them");
    require_count(source, "inverseBindMatrices of " + name, accessors.count(matrices),
                  skin.member("joints").elements().size());
}

void require_whole_channel(const MeshSource& source, const Accessors& accessors, const JsonView& channel,
                           const std::vector<JsonView>& samplers, const std::string& name) {
    const auto number = channel.member("sampler").natural_number();
    if (!number || *number >= samplers.size()) return; // Assimp passes over it
    const JsonView& sampler = samplers[*number];
    const std::size_t time_count = accessors.count(sampler.member("input"));
    const std::size_t value_count = accessors.count(sampler.member("output"));
    if (time_count == 0) source.fail(ErrorCode::InvalidMesh, name + " has a channel without keys");
    const std::size_t values_per_key = sampler.member("interpolation").string() == "CUBICSPLINE" ? 3 : 1;
    const bool has_weights = channel.member("target").member("path").string() == "weights";
    const std::size_t expected = values_per_key * time_count;
    // Weights have as many values for a key as there are morph targets.
    const bool whole = has_weights ? value_count > 0 && value_count % expected == 0 : value_count == expected;
    if (!whole)
        source.fail(ErrorCode::InvalidMesh, name + " has a channel with " + std::to_string(value_count) +
                                                " values for " + std::to_string(time_count) +
                                                " keys; export the file again");
}

/// Is this a key in which a character that needs no escape is escaped?
bool is_disguised_key(std::string_view json, std::size_t begin, std::size_t end) {
    const std::size_t next = json.find_first_not_of(" \t\r\n", end);
    if (next == std::string_view::npos || json[next] != ':') return false;
    const std::string_view key = json.substr(begin, end - begin);
    for (std::size_t at = key.find("\\u00"); at != std::string_view::npos; at = key.find("\\u00", at + 1))
        if (at + 4 < key.size() && key[at + 4] >= '2' && key[at + 4] <= '7') return true;
    return false;
}

void require_plain_keys(const MeshSource& source, std::string_view json) {
    for (std::size_t i = json.find('"'); i < json.size(); i = json.find('"', i)) {
        const std::size_t end = end_of_json_string(json, i);
        if (is_disguised_key(json, i, end))
            source.fail(ErrorCode::WrongFormat,
                        "the key " + in_quotes(json.substr(i, end - i)) +
                            " is written with \\u in place of letters, and is not read");
        i = end;
    }
}

std::string numbered(const char* what, std::size_t number) {
    return std::string(what) + " " + std::to_string(number);
}

/// Calls visit(primitive, "mesh 3").
template <typename Visit>
void for_each_primitive(const JsonView& root, Visit&& visit) {
    const std::vector<JsonView> meshes = root.member("meshes").elements();
    for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh)
        for (const JsonView& primitive : meshes[mesh].member("primitives").elements())
            visit(primitive, numbered("mesh", mesh));
}

/// Calls visit(channel, samplers, "animation 3").
template <typename Visit>
void for_each_channel(const JsonView& root, Visit&& visit) {
    const std::vector<JsonView> animations = root.member("animations").elements();
    for (std::size_t animation = 0; animation < animations.size(); ++animation) {
        const std::vector<JsonView> samplers = animations[animation].member("samplers").elements();
        for (const JsonView& channel : animations[animation].member("channels").elements())
            visit(channel, samplers, numbered("animation", animation));
    }
}

[[noreturn]] void refuse_type(const MeshSource& source, const std::string& what) {
    source.fail(ErrorCode::WrongFormat,
                what + " are not of the type that is read; export the file with numbers in floating point");
}

void require_plain_skin(const MeshSource& source, const Accessors& accessors, const JsonView& primitive,
                        const std::string& mesh) {
    const JsonView attributes = primitive.member("attributes");
    if (attributes.member("JOINTS_1").exists())
        source.fail(ErrorCode::WrongFormat,
                    mesh + " has vertices with more than four bones; export it with at most four");
    const JsonView weights = attributes.member("WEIGHTS_0"), joints = attributes.member("JOINTS_0");
    if (!weights.exists()) return;
    if (accessors.component_type(weights) != kFloat || accessors.type(weights) != "VEC4")
        refuse_type(source, "the weights of " + mesh);
    const std::size_t type = accessors.component_type(joints);
    if ((type != kUnsignedByte && type != kUnsignedShort) || accessors.type(joints) != "VEC4")
        refuse_type(source, "the joints of " + mesh);
}

void require_plain_channel(const MeshSource& source, const Accessors& accessors, const JsonView& channel,
                           const std::vector<JsonView>& samplers, const std::string& animation) {
    const auto number = channel.member("sampler").natural_number();
    if (!number || *number >= samplers.size()) return;
    const auto path = channel.member("target").member("path").string();
    const std::string_view expected = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
    const JsonView output = samplers[*number].member("output");
    if (accessors.component_type(output) != kFloat || accessors.type(output) != expected)
        refuse_type(source, "values of " + animation);
}

} // namespace

void require_whole_gltf_animations(const MeshSource& source, std::string_view json) {
    require_plain_keys(source, json);
    const JsonView root(json);
    const Accessors accessors(root);
    for_each_primitive(root, [&](const JsonView& primitive, const std::string& mesh) {
        require_whole_primitive(source, accessors, primitive, mesh);
    });
    const std::vector<JsonView> skins = root.member("skins").elements();
    for (std::size_t skin = 0; skin < skins.size(); ++skin)
        require_whole_skin(source, accessors, skins[skin], numbered("skin", skin));
    for_each_channel(root, [&](const JsonView& channel, const std::vector<JsonView>& samplers,
                               const std::string& animation) {
        require_whole_channel(source, accessors, channel, samplers, animation);
    });
}

void require_plain_gltf_animations(const MeshSource& source, std::string_view json) {
    const JsonView root(json);
    const Accessors accessors(root);
    for_each_primitive(root, [&](const JsonView& primitive, const std::string& mesh) {
        require_plain_skin(source, accessors, primitive, mesh);
    });
    for_each_channel(root, [&](const JsonView& channel, const std::vector<JsonView>& samplers,
                               const std::string& animation) {
        require_plain_channel(source, accessors, channel, samplers, animation);
    });
}

} // namespace echinus
