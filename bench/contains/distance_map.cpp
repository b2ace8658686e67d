#include "contains/system.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/instruction_set.hpp>

#include <optional>

using namespace echinus;

namespace {

class DistanceMapContains : public ContainsSystem {
  public:
    /// @param count  spherical: samples along each of the two angles; octahedral: divisions of an edge
    DistanceMapContains(DirectionGrid grid, std::uint32_t count) {
        options_.grid = grid;
        options_.longitude_count = options_.colatitude_count = options_.divisions = count;
        options_.thread_count = 1;
    }
    void build(const TriangleMesh& mesh) override { map_ = DistanceMap::build(mesh, options_); }
    std::size_t byte_count() const override { return map_->view().byte_count(); }

    std::vector<ContainsWay> ways() override {
        std::vector<ContainsWay> ways;
        for (const std::string_view set : available_instruction_sets())
            ways.push_back({"batch " + std::string(set),
                            [this, set](auto points, auto inside) {
                                use_instruction_set(set);
                                contains_batch(map_->view(), points, inside);
                            },
                            true});
        ways.push_back({"one by one", [this](auto points, auto inside) {
                            for (std::size_t i = 0; i < points.size(); ++i)
                                inside[i] = contains(map_->view(), points[i]);
                        }});
        return ways;
    }

  private:
    DistanceMapOptions options_;
    std::optional<DistanceMap> map_;
};

Listed<ContainsSystem> spherical(std::uint32_t count) {
    return listed<DistanceMapContains, ContainsSystem>("distance map", Role::Ours, true,
                                                       DirectionGrid::Spherical, count);
}

Listed<ContainsSystem> octahedral(std::uint32_t count) {
    return listed<DistanceMapContains, ContainsSystem>("octahedral distance map", Role::Ours, true,
                                                       DirectionGrid::Octahedral, count);
}

} // namespace

void list_distance_map(ContainsList& list) {
    list.push_back(spherical(DistanceMapOptions{}.longitude_count));
    list.push_back(octahedral(DistanceMapOptions{}.divisions));
}

void list_sizes_of_distance_map(ContainsList& list) {
    for (const std::uint32_t count : {50U, 100U, 200U, 400U, 800U}) list.push_back(spherical(count));
    for (const std::uint32_t count : {25U, 50U, 100U, 200U, 400U}) list.push_back(octahedral(count));
}
