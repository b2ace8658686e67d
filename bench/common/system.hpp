#pragma once

#include "rivals/depth_normal.hpp"

#include <echinus/contact.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// What systems are asked for.
enum class Task {
    Contains, ///< the sign of every particle
    Contacts, ///< the sign of every particle, depth and normal of those inside
};

/// Which side of the comparison a system is on.
enum class Role {
    Ours,
    Rival,
    Floor, ///< no answer at all, only what every answer costs at least
};

/// One way to ask a structure. It keeps what it answered, in the form that its users would have it in.
struct Way {
    std::string name;
    /// Answers for particles [first, first + points.size()) of a set.
    std::function<void(std::span<const echinus::Vec3f> points, std::size_t first)> answer;
    /// What was answered for particle i; where only the sign was asked the depth is 1 or 0.
    std::function<DepthNormal(std::size_t i)> answered;
    bool as_whole = false; ///< gains by the number of particles in a call: never asked for parts of a set
};

using Ways = std::vector<Way>;

/// What a system built around a mesh.
struct Structure {
    /// All that queries read, where the library tells; what it took from the heap otherwise.
    std::size_t byte_count;
    /// The ways to ask it, which live as long as the structure does.
    /// @param point_count  of the largest set: room for so many answers is made here, not while the clock
    /// runs
    std::function<Ways(std::size_t point_count)> ways;
};

/// A system, ready to build its structure around a mesh that outlives both.
struct System {
    std::string name;
    Role role;
    std::function<Structure()> build;
};

// ---- For those who list systems

template <typename Holder>
std::size_t byte_count_of(const Holder& holder) {
    if constexpr (requires { holder.view(); }) // a map of ours
        return holder.view().byte_count();
    else
        return holder.byte_count();
}

/// @param build  returns a shared pointer to what holds the structure
/// @param ways   Ways (const holder&, std::size_t point_count)
template <typename Build, typename AskedBy>
System system_of(std::string name, Role role, Build build, AskedBy ways) {
    return {std::move(name), role, [=] {
                const auto holder = build();
                return Structure{byte_count_of(*holder),
                                 [=](std::size_t point_count) { return ways(*holder, point_count); }};
            }};
}

inline DepthNormal depth_normal_of(std::uint8_t inside) {
    return {inside != 0 ? 1.0F : 0.0F, {}};
}

inline DepthNormal depth_normal_of(const DepthNormal& answer) {
    return answer;
}

inline DepthNormal depth_normal_of(const echinus::Contact& contact) {
    return contact.inside ? DepthNormal{contact.depth, contact.normal} : DepthNormal{};
}

/// A way that writes an array of answers.
/// @param fill  void (std::span<const Vec3f> points, std::span<Answer> answers)
template <typename Answer, typename Fill>
Way way_of(std::string name, std::size_t point_count, Fill fill) {
    const auto answers = std::make_shared<std::vector<Answer>>(point_count);
    return {std::move(name),
            [=](std::span<const echinus::Vec3f> points, std::size_t first) {
                fill(points, std::span(*answers).subspan(first, points.size()));
            },
            [=](std::size_t i) { return depth_normal_of((*answers)[i]); }};
}

/// A way that asks for each particle by itself.
/// @param query  Answer (const Vec3f& point)
template <typename Answer, typename Query>
Way way_one_by_one(std::string name, std::size_t point_count, Query query) {
    return way_of<Answer>(std::move(name), point_count, [=](auto points, auto answers) {
        for (std::size_t i = 0; i < points.size(); ++i) answers[i] = query(points[i]);
    });
}
