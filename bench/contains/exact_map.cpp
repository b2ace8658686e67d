#include "contains/system.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/instruction_set.hpp>

#include <optional>

using namespace echinus;

namespace {

class ExactMapContains : public ContainsSystem {
  public:
    /// @param divisions  as in ExactMapOptions
    explicit ExactMapContains(std::uint32_t divisions) {
        options_.divisions = divisions;
        options_.thread_count = 1;
    }
    void build(const TriangleMesh& mesh) override { map_ = ExactMap::build(mesh, options_); }
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
    ExactMapOptions options_;
    std::optional<ExactMap> map_;
};

} // namespace

void list_exact_map(ContainsList& list) {
    list.push_back(listed<ExactMapContains, ContainsSystem>("exact map", Role::Ours, true, 0U));
}

void list_sizes_of_exact_map(ContainsList& list) {
    for (const std::uint32_t divisions : {8U, 12U, 16U, 24U, 32U, 48U, 64U, 96U})
        list.push_back(listed<ExactMapContains, ContainsSystem>("exact map", Role::Ours, true, divisions));
}
