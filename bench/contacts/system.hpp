#pragma once

#include "common/system.hpp"
#include "rivals/depth_normal.hpp"

#include <cstdint>
#include <memory>
#include <span>

/// One way to ask a system for contacts: the sign of every particle, depth and normal of those inside. It
/// keeps what it answered, in the form that its users would have it in.
struct ContactsWay {
    std::string name;
    /// Answers for particles [first, first + points.size()) of the set.
    std::function<void(std::span<const echinus::Vec3f> points, std::size_t first)> answer;
    /// What was answered for particle i.
    std::function<DepthNormal(std::size_t i)> answered;
    bool as_whole = false; ///< gains by the number of particles in a call: never asked for parts of a set
};

/// A system in the task "contacts".
class ContactsSystem : public Structure {
  public:
    /// After build(); they live as long as the system.
    /// @param point_count  the size of the set: room for so many answers is made here, not while the clock
    /// runs
    virtual std::vector<ContactsWay> ways(std::size_t point_count) = 0;
};

using ContactsList = std::vector<Listed<ContactsSystem>>;

/// A way that writes DepthNormal.
/// @param fill  void (std::span<const Vec3f> points, std::span<DepthNormal> contacts)
template <typename Fill>
ContactsWay depth_normal_way(std::string name, std::size_t point_count, Fill fill) {
    const auto answers = std::make_shared<std::vector<DepthNormal>>(point_count);
    return {std::move(name),
            [=](std::span<const echinus::Vec3f> points, std::size_t first) {
                fill(points, std::span(*answers).subspan(first, points.size()));
            },
            [=](std::size_t i) { return (*answers)[i]; }};
}

// A function for each file beside this one.
void list_exact_map(ContactsList& list);
void list_distance_map(ContactsList& list);
void list_dense_grid(ContactsList& list);
void list_classified_grid(ContactsList& list);
void list_nanovdb(ContactsList& list);
void list_openvdb(ContactsList& list);
void list_embree(ContactsList& list);
void list_cgal(ContactsList& list);
void list_fcl(ContactsList& list);

// The same in several sizes, from small to large.
void list_sizes_of_exact_map(ContactsList& list);
void list_sizes_of_distance_map(ContactsList& list);
void list_sizes_of_dense_grid(ContactsList& list);
void list_sizes_of_classified_grid(ContactsList& list);

/// The rivals that this build has, in the order of the tables.
[[gnu::visibility("default")]] void list_contacts_rivals(ContactsList& list);

/// Those of them that come in sizes.
[[gnu::visibility("default")]] void list_sizes_of_contacts_rivals(ContactsList& list);
