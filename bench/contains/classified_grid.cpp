
#include "rivals/classified_grid.hpp"

#include "contains/system.hpp"

#include <optional>

using namespace echinus;

namespace {

class ClassifiedGridContains : public ContainsSystem {
  public:
    /// @param budget  bytes; 0: as many as the exact map has
    explicit ClassifiedGridContains(std::size_t budget) : budget_(budget) {}
    void plan(const TriangleMesh& mesh) override {
        if (budget_ == 0) budget_ = bytes_of_exact_map(mesh);
    }
    void build(const TriangleMesh& mesh) override { grid_ = baselines::ClassifiedGrid::build(mesh, budget_); }
    std::size_t byte_count() const override { return grid_->byte_count(); }
    std::vector<ContainsWay> ways() override {
        return {{"batch", [this](auto points, auto inside) { grid_->contains_batch(points, inside); }, true}};
    }

  private:
    std::size_t budget_;
    std::optional<baselines::ClassifiedGrid> grid_;
};

} // namespace

void list_classified_grid(ContainsList& list) {
    list.push_back(
        listed<ClassifiedGridContains, ContainsSystem>("classified grid", Role::Rival, true, std::size_t{0}));
}

void list_sizes_of_classified_grid(ContainsList& list) {
    for (const std::size_t bytes : {170'000U, 220'000U, 280'000U, 400'000U, 800'000U, 1'600'000U})
        list.push_back(
            listed<ClassifiedGridContains, ContainsSystem>("classified grid", Role::Rival, true, bytes));
}
