#pragma once

#include "common/comparison.hpp"
#include "contacts/system.hpp"

/// Ours and the rivals, in the order of the tables.
ContactsList all_contacts_systems();

/// Those that come in sizes.
ContactsList all_contacts_sizes();

/// A structure of each system that takes part, and the ways to ask them.
class ContactsField {
  public:
    /// @param one_way  only the first way of each system, which is its best
    ContactsField(const Subject& subject, std::size_t point_count, const ContactsList& systems,
                  bool one_way = false);

    const std::vector<Competitor>& competitors() const { return competitors_; }

  private:
    std::vector<std::unique_ptr<ContactsSystem>> systems_; // which the competitors refer to
    std::vector<Competitor> competitors_;
};
