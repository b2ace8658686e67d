#pragma once

#include "common/system.hpp"

#include <echinus/instruction_set.hpp>

/// The ways to ask a map of ours: a batch with each instruction set of this machine, the widest vectors
/// first, and last a query for each particle.
/// @param batch  void (std::span<const Vec3f> points, std::span<Answer> answers)
/// @param query  Answer (const Vec3f& point)
template <typename Answer, typename Batch, typename Query>
Ways our_ways(std::size_t point_count, Batch batch, Query query) {
    Ways ways;
    for (const std::string_view set : echinus::available_instruction_sets()) {
        ways.push_back(
            way_of<Answer>("batch " + std::string(set), point_count, [=](auto points, auto answers) {
                const std::string_view before = echinus::instruction_set(); // rivals choose like ours
                echinus::use_instruction_set(set);
                batch(points, answers);
                echinus::use_instruction_set(before);
            }));
        ways.back().as_whole = true;
    }
    ways.push_back(way_one_by_one<Answer>("one by one", point_count, query));
    return ways;
}
