#pragma once

#include "border.hpp"

#include <echinus/any_map.hpp>
#include <echinus/collider.hpp>
#include <echinus/echinus.h>

/// Immutable. Copies share the arrays of a map.
struct echinus_map {
    echinus::ColliderMap value;
};
struct echinus_map_builder {
    echinus::ExactMapBuilder value;
};

namespace echinus::c {

/// The layouts of the answers are those of C++, which are written in place.
static_assert(sizeof(echinus_contact) == sizeof(Contact) &&
              offsetof(echinus_contact, point) == offsetof(Contact, point) &&
              offsetof(echinus_contact, normal) == offsetof(Contact, normal) &&
              offsetof(echinus_contact, depth) == offsetof(Contact, depth) &&
              offsetof(echinus_contact, face) == offsetof(Contact, face) &&
              offsetof(echinus_contact, inside) == offsetof(Contact, inside) &&
              offsetof(echinus_contact, certain) == offsetof(Contact, certain) &&
              offsetof(echinus_contact, feature) == offsetof(Contact, feature));
static_assert(sizeof(echinus_sweep_hit) == sizeof(SweepHit) &&
              offsetof(echinus_sweep_hit, fraction) == offsetof(SweepHit, fraction) &&
              offsetof(echinus_sweep_hit, point) == offsetof(SweepHit, point) &&
              offsetof(echinus_sweep_hit, normal) == offsetof(SweepHit, normal) &&
              offsetof(echinus_sweep_hit, face) == offsetof(SweepHit, face) &&
              offsetof(echinus_sweep_hit, entering) == offsetof(SweepHit, entering));

/// Calls a function of the caller's when it goes, once it was armed: until then what it releases is the
/// caller's.
class Release {
  public:
    Release(void (*function)(void*), void* context) : function_(function), context_(context) {}
    Release(const Release&) = delete;
    Release& operator=(const Release&) = delete;
    ~Release() {
        if (armed_ && function_ != nullptr) function_(context_);
    }
    void arm() { armed_ = true; }

  private:
    void (*function_)(void*);
    void* context_;
    bool armed_ = false;
};

/// @throws WrongArgument for a map of another kind
const ExactMap& exact_map_at(const echinus_map* map);
const DistanceMap& distance_map_at(const echinus_map* map);

/// @throws WrongArgument for a custom map
AnyMap any_map_at(const echinus_map* map);

/// Calls body(map) with the exact map or the distance map.
/// @throws WrongArgument for a custom map
template <typename Body>
void with_map(const echinus_map* map, const Body& body) {
    const ColliderMap::Kind& kind = at(map, "map").value.kind;
    if (const auto* exact = std::get_if<ExactMap>(&kind)) return body(*exact);
    if (const auto* distance = std::get_if<DistanceMap>(&kind)) return body(*distance);
    throw WrongArgument("map is a custom map, which only colliders can ask");
}

/// A margin, a reach or another length to look for.
/// @throws WrongArgument unless it is 0 or more
inline float not_negative(float length, const char* name) {
    if (!(length >= 0))
        throw WrongArgument(std::string(name) + " is " + std::to_string(length) + "; expected 0 or more");
    return length;
}

inline std::span<Contact> contacts_at(echinus_contact* first, std::size_t count) {
    return values_at(reinterpret_cast<Contact*>(first), count, "contacts");
}
inline std::span<SweepHit> hits_at(echinus_sweep_hit* first, std::size_t count) {
    return values_at(reinterpret_cast<SweepHit*>(first), count, "hits");
}

} // namespace echinus::c
