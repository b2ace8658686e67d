#include "contacts/contact_way.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/instruction_set.hpp>

#include <optional>

using namespace echinus;

namespace {

class DistanceMapContacts : public ContactsSystem {
  public:
    /// @param count  spherical: samples along each of the two angles; octahedral: divisions of an edge
    DistanceMapContacts(DirectionGrid grid, std::uint32_t count) {
        options_.grid = grid;
        options_.longitude_count = options_.colatitude_count = options_.divisions = count;
        options_.thread_count = 1;
    }
    void build(const TriangleMesh& mesh) override { map_ = DistanceMap::build(mesh, options_); }
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
    DistanceMapOptions options_;
    std::optional<DistanceMap> map_;
};

Listed<ContactsSystem> spherical(std::uint32_t count) {
    return listed<DistanceMapContacts, ContactsSystem>("distance map", Role::Ours, true,
                                                       DirectionGrid::Spherical, count);
}

Listed<ContactsSystem> octahedral(std::uint32_t count) {
    return listed<DistanceMapContacts, ContactsSystem>("octahedral distance map", Role::Ours, true,
                                                       DirectionGrid::Octahedral, count);
}

} // namespace

void list_distance_map(ContactsList& list) {
    list.push_back(spherical(DistanceMapOptions{}.longitude_count));
    list.push_back(octahedral(DistanceMapOptions{}.divisions));
}

void list_sizes_of_distance_map(ContactsList& list) {
    for (const std::uint32_t count : {50U, 100U, 200U, 400U, 800U}) list.push_back(spherical(count));
    for (const std::uint32_t count : {25U, 50U, 100U, 200U, 400U}) list.push_back(octahedral(count));
}
