#include "contains/system.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/instruction_set.hpp>

#include <optional>

using namespace echinus;

namespace {

class DistanceMapContains : public ContainsSystem {
  public:
    /// @param sample_count  along each of the two angles
    explicit DistanceMapContains(std::uint32_t sample_count) {
        options_.longitude_count = options_.colatitude_count = sample_count;
        options_.thread_count = 1;
    }
    void build(const TriangleMesh& mesh) override { map_ = DistanceMap::build(mesh, options_); }
    std::size_t byte_count() const override { return map_->view().byte_count(); }

    std::vector<ContainsWay> ways() override {
        std::vector<ContainsWay> ways;
        for (const std::string_view set : available_instruction_sets())
            ways.push_back({"batch " + std::string(set), [this, set](auto points, auto inside) {
                                use_instruction_set(set);
                                contains_batch(map_->view(), points, inside);
                            }});
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

} // namespace

void list_distance_map(ContainsList& list) {
    list.push_back(listed<DistanceMapContains, ContainsSystem>("distance map", Role::Ours, true,
                                                               DistanceMapOptions{}.longitude_count));
}

void list_sizes_of_distance_map(ContainsList& list) {
    for (const std::uint32_t sample_count : {50U, 100U, 200U, 400U, 800U})
        list.push_back(
            listed<DistanceMapContains, ContainsSystem>("distance map", Role::Ours, true, sample_count));
}
