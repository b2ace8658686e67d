#include "contacts/contact_way.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/instruction_set.hpp>

#include <optional>

using namespace echinus;

namespace {

class ExactMapContacts : public ContactsSystem {
  public:
    /// @param divisions  as in ExactMapOptions
    explicit ExactMapContacts(std::uint32_t divisions) {
        options_.divisions = divisions;
        options_.thread_count = 1;
    }
    void build(const TriangleMesh& mesh) override { map_ = ExactMap::build(mesh, options_); }
    std::size_t byte_count() const override { return map_->view().byte_count(); }

    std::vector<ContactsWay> ways(std::size_t point_count) override {
        std::vector<ContactsWay> ways;
        for (const std::string_view set : available_instruction_sets()) {
            ways.push_back(contact_way("batch " + std::string(set), point_count,
                                       [this, set](auto points, auto contacts) {
                                           use_instruction_set(set);
                                           contacts_batch(map_->view(), points, 0, contacts);
                                       }));
            ways.back().as_whole = true;
        }
        ways.push_back(contact_way("one by one", point_count, [this](auto points, auto contacts) {
            for (std::size_t i = 0; i < points.size(); ++i) contacts[i] = contact(map_->view(), points[i]);
        }));
        return ways;
    }

  private:
    ExactMapOptions options_;
    std::optional<ExactMap> map_;
};

} // namespace

void list_exact_map(ContactsList& list) {
    list.push_back(listed<ExactMapContacts, ContactsSystem>("exact map", Role::Ours, true, 0U));
}

void list_sizes_of_exact_map(ContactsList& list) {
    for (const std::uint32_t divisions : {8U, 12U, 16U, 24U, 32U, 48U, 64U, 96U})
        list.push_back(listed<ExactMapContacts, ContactsSystem>("exact map", Role::Ours, true, divisions));
}
