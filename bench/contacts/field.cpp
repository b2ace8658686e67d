#include "contacts/field.hpp"

using namespace echinus;

namespace {

Competitor competitor_of(const Listed<ContactsSystem>& listed, const ContactsSystem& system, double build_ms,
                         ContactsWay way) {
    return {listed.name, way.name,     listed.role,           system.byte_count(),
            build_ms,    way.as_whole, std::move(way.answer), std::move(way.answered)};
}

} // namespace

ContactsList all_contacts_systems() {
    ContactsList list;
    list_exact_map(list);
    list_distance_map(list);
    list_contacts_rivals(list);
    return list;
}

ContactsList all_contacts_sizes() {
    ContactsList list;
    list_sizes_of_exact_map(list);
    list_sizes_of_distance_map(list);
    list_sizes_of_contacts_rivals(list);
    return list;
}

ContactsField::ContactsField(const Subject& subject, std::size_t point_count, const ContactsList& systems,
                             bool one_way) {
    for (const Listed<ContactsSystem>& listed : systems) {
        if (subject.large && !listed.joins_large) continue;
        std::unique_ptr<ContactsSystem> system;
        const double build_ms = time_build(listed, subject.mesh, system);
        for (ContactsWay& way : system->ways(point_count)) {
            competitors_.push_back(competitor_of(listed, *system, build_ms, std::move(way)));
            if (one_way) break;
        }
        systems_.push_back(std::move(system));
    }
}
