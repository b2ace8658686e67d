#include "rivals/dense_grid.hpp"

#include "contacts/system.hpp"

#include <echinus/distance_map.hpp>

using namespace echinus;

namespace {

/// The grid's answers, an array a component.
struct Arrays {
    explicit Arrays(std::size_t count) : depths(count), x(count), y(count), z(count) {}

    baselines::DenseGrid::Contacts from(std::size_t first, std::size_t count) {
        const auto part = [&](std::vector<float>& all) { return std::span(all).subspan(first, count); };
        return {part(depths), part(x), part(y), part(z)};
    }

    std::vector<float> depths, x, y, z;
};

class DenseGridContacts : public ContactsSystem {
  public:
    explicit DenseGridContacts(GridSize size) : size_(size) {}
    void build(const TriangleMesh& mesh) override { grid_ = grid_of(mesh, size_); }
    std::size_t byte_count() const override { return grid_->byte_count(); }

    std::vector<ContactsWay> ways(std::size_t point_count) override {
        const auto arrays = std::make_shared<Arrays>(point_count);
        return {{"vector loop",
                 [=, this](std::span<const Vec3f> points, std::size_t first) {
                     grid_->contacts_batch(points, arrays->from(first, points.size()));
                 },
                 [=](std::size_t i) {
                     const float depth = arrays->depths[i];
                     if (!(depth > 0)) return DepthNormal{};
                     return DepthNormal{depth, {arrays->x[i], arrays->y[i], arrays->z[i]}};
                 }}};
    }

  protected:
    GridSize size_;
    std::optional<baselines::DenseGrid> grid_;
};

/// With as many bytes as the distance map has, which it is compared with.
class EqualDenseGrid : public DenseGridContacts {
  public:
    EqualDenseGrid() : DenseGridContacts({}) {}
    void plan(const TriangleMesh& mesh) override {
        size_.bytes = DistanceMap::build(mesh).view().byte_count();
    }
};

} // namespace

void list_dense_grid(ContactsList& list) {
    list.push_back(listed<EqualDenseGrid, ContactsSystem>("dense grid as many bytes as the distance map",
                                                          Role::Rival, true));
    for (const GridSize size : kGridSizes)
        list.push_back(
            listed<DenseGridContacts, ContactsSystem>(size.name, Role::Rival, size.bytes != 0, size));
}

void list_sizes_of_dense_grid(ContactsList& list) {
    for (const std::size_t bytes : {40'000U, 160'000U, 630'000U, 2'500'000U, 6'400'000U})
        list.push_back(listed<DenseGridContacts, ContactsSystem>("dense grid", Role::Rival, true,
                                                                 GridSize{"", bytes, 0}));
}
