// Queries of maps and of colliders for many points.

#include "handles.hpp"

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_map_contains(const echinus_map* map, const float* points, size_t count, size_t stride,
                                    uint32_t thread_count, uint8_t* inside) {
    return guarded(__func__, [&] {
        with_map(map, [&](const auto& kind) {
            const auto batch = batch_at<Vec3f>(points, count, stride, "points");
            const std::span<uint8_t> answers = values_at(inside, count, "inside");
            if (count == 1) // the same bits, without the overhead of a batch
                answers[0] = contains(kind.view(), batch[0]) ? 1 : 0;
            else
                contains_batch(kind.view(), batch, answers, thread_count);
        });
    });
}

echinus_status echinus_map_classify(const echinus_map* map, const float* points, size_t count, size_t stride,
                                    uint32_t thread_count, uint8_t* inside, uint8_t* certain) {
    return guarded(__func__, [&] {
        const auto batch = batch_at<Vec3f>(points, count, stride, "points");
        const std::span<uint8_t> sides = values_at(inside, count, "inside");
        const std::span<uint8_t> certainties = values_at(certain, count, "certain");
        with_map(map, [&](const auto& kind) {
            if constexpr (std::same_as<decltype(kind), const ExactMap&>) {
                std::vector<Containment> answers(count);
                classify_batch(kind.view(), batch, answers, thread_count);
                for (std::size_t i = 0; i < count; ++i) {
                    sides[i] = answers[i].inside ? 1 : 0;
                    certainties[i] = answers[i].certain ? 1 : 0;
                }
            } else {
                contains_batch(kind.view(), batch, sides, thread_count);
                std::fill(certainties.begin(), certainties.end(), std::uint8_t{1});
            }
        });
    });
}

echinus_status echinus_map_contacts(const echinus_map* map, const float* points, size_t count, size_t stride,
                                    float margin, uint32_t thread_count, echinus_contact* contacts) {
    return guarded(__func__, [&] {
        with_map(map, [&](const auto& kind) {
            const auto batch = batch_at<Vec3f>(points, count, stride, "points");
            const std::span<Contact> answers = contacts_at(contacts, count);
            not_negative(margin, "margin");
            if (count == 1)
                answers[0] = contact(kind.view(), batch[0], margin);
            else
                contacts_batch(kind.view(), batch, margin, answers, thread_count);
        });
    });
}

echinus_status echinus_map_signed_distance(const echinus_map* map, const float* points, size_t count,
                                           size_t stride, uint32_t thread_count, float* distances,
                                           float* gradients) {
    return guarded(__func__, [&] {
        const std::size_t gradient_count = gradients == nullptr ? 0 : count;
        signed_distance_batch(exact_map_at(map).view(), batch_at<Vec3f>(points, count, stride, "points"),
                              values_at(distances, count, "distances"),
                              values_at(reinterpret_cast<Vec3f*>(gradients), gradient_count, "gradients"),
                              thread_count);
    });
}

echinus_status echinus_map_winding_number(const echinus_map* map, const float* points, size_t count,
                                          size_t stride, float tolerance, uint32_t thread_count,
                                          float* winding_numbers) {
    return guarded(__func__, [&] {
        winding_number_batch(exact_map_at(map).view(), batch_at<Vec3f>(points, count, stride, "points"),
                             values_at(winding_numbers, count, "winding_numbers"),
                             not_negative(tolerance, "tolerance"), thread_count);
    });
}

echinus_status echinus_map_sweep(const echinus_map* map, const float* from, size_t from_stride,
                                 const float* to, size_t to_stride, size_t count, uint32_t thread_count,
                                 echinus_sweep_hit* hits) {
    return guarded(__func__, [&] {
        const ExactMapView& view = exact_map_at(map).view();
        const auto starts = batch_at<Vec3f>(from, count, from_stride, "from");
        const auto ends = batch_at<Vec3f>(to, count, to_stride, "to");
        const std::span<SweepHit> found = hits_at(hits, count);
        sweep_batch(view, starts, ends, found, thread_count);
    });
}

// ---- In the world

echinus_status echinus_collider_contains(const echinus_collider* collider, const float* points, size_t count,
                                         size_t stride, uint32_t thread_count, uint8_t* inside) {
    return guarded(__func__, [&] {
        contains_batch(collider_at(collider), batch_at<Vec3f>(points, count, stride, "points"),
                       values_at(inside, count, "inside"), thread_count);
    });
}

echinus_status echinus_collider_contacts(const echinus_collider* collider, const float* points, size_t count,
                                         size_t stride, float margin, uint32_t thread_count,
                                         echinus_contact* contacts) {
    return guarded(__func__, [&] {
        contacts_batch(collider_at(collider), batch_at<Vec3f>(points, count, stride, "points"),
                       not_negative(margin, "margin"), contacts_at(contacts, count), thread_count);
    });
}

echinus_status echinus_collider_sweep(const echinus_collider* collider, const echinus_pose* previous,
                                      const float* from, size_t from_stride, const float* to,
                                      size_t to_stride, size_t count, uint32_t thread_count,
                                      echinus_sweep_hit* hits) {
    return guarded(__func__, [&] {
        const Collider present = collider_at(collider);
        const RigidTransform before = checked_pose(at(previous, "previous"), "previous");
        const auto starts = batch_at<Vec3f>(from, count, from_stride, "from");
        const auto ends = batch_at<Vec3f>(to, count, to_stride, "to");
        const std::span<SweepHit> found = hits_at(hits, count);
        sweep_batch(present, before, starts, ends, found, thread_count);
    });
}
