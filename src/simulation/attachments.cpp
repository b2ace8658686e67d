#include "simulation/attachments.hpp"

namespace echinus {

Attachments::Attachments(const Deformable& deformable, const std::vector<Collider>& colliders) {
    for (const auto& [particle, collider] : deformable.attachments)
        places_.push_back(
            {particle, collider, colliders[collider].pose.to_local(Vec3d(deformable.positions[particle]))});
}

void Attachments::follow(const std::vector<Collider>& colliders, PointArrays& positions) const {
    for (const Place& place : places_)
        if (colliders[place.collider].moves())
            positions.set(place.particle, Vec3f(colliders[place.collider].pose.to_world(place.from_pose)));
}

} // namespace echinus
