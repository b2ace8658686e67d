
#include "rivals/dense_grid.hpp"

#include "contains/system.hpp"

using namespace echinus;

namespace {

class DenseGridContains : public ContainsSystem {
  public:
    explicit DenseGridContains(GridSize size) : size_(size) {}
    void build(const TriangleMesh& mesh) override { grid_ = grid_of(mesh, size_); }
    std::size_t byte_count() const override { return grid_->byte_count(); }
    std::vector<ContainsWay> ways() override {
        return {{"vector loop", [this](auto points, auto inside) { grid_->contains_batch(points, inside); }}};
    }

  private:
    GridSize size_;
    std::optional<baselines::DenseGrid> grid_;
};

} // namespace

void list_dense_grid(ContainsList& list) {
    for (const GridSize size : kGridSizes)
        list.push_back(
            listed<DenseGridContains, ContainsSystem>(size.name, Role::Rival, size.bytes != 0, size));
}

void list_sizes_of_dense_grid(ContainsList& list) {
    for (const std::size_t bytes : {40'000U, 160'000U, 630'000U, 2'500'000U, 6'400'000U})
        list.push_back(listed<DenseGridContains, ContainsSystem>("dense grid", Role::Rival, true,
                                                                 GridSize{"", bytes, 0}));
}
