#include "rivals/classified_grid.hpp"

#include "contacts/contact_way.hpp"

#include <optional>

using namespace echinus;

namespace {

class ClassifiedGridContacts : public ContactsSystem {
  public:
    /// @param budget  bytes; 0: as many as the exact map has
    explicit ClassifiedGridContacts(std::size_t budget) : budget_(budget) {}
    void plan(const TriangleMesh& mesh) override {
        if (budget_ == 0) budget_ = bytes_of_exact_map(mesh);
    }
    void build(const TriangleMesh& mesh) override { grid_ = baselines::ClassifiedGrid::build(mesh, budget_); }
    std::size_t byte_count() const override { return grid_->byte_count(); }
    std::vector<ContactsWay> ways(std::size_t point_count) override {
        ContactsWay way = contact_way("batch", point_count, [this](auto points, auto contacts) {
            grid_->contacts_batch(points, 0, contacts);
        });
        way.as_whole = true;
        return {std::move(way)};
    }

  private:
    std::size_t budget_;
    std::optional<baselines::ClassifiedGrid> grid_;
};

} // namespace

void list_classified_grid(ContactsList& list) {
    list.push_back(
        listed<ClassifiedGridContacts, ContactsSystem>("classified grid", Role::Rival, true, std::size_t{0}));
}

void list_sizes_of_classified_grid(ContactsList& list) {
    for (const std::size_t bytes : {170'000U, 220'000U, 280'000U, 400'000U, 800'000U, 1'600'000U})
        list.push_back(
            listed<ClassifiedGridContacts, ContactsSystem>("classified grid", Role::Rival, true, bytes));
}
