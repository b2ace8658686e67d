// The caller's own structures as maps.

#include "handles.hpp"

namespace echinus::c {

ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_custom_map, release);

namespace {

class MapOfFunctions final : public CustomMap {
  public:
    explicit MapOfFunctions(const echinus_custom_map& custom)
        : custom_(custom), release_(custom.release, custom.context) {}

    void arm() { release_.arm(); }

    void contains_batch(std::span<const Vec3f> points,
                        std::span<std::uint8_t> inside) const noexcept override {
        custom_.contains(custom_.context, floats(points), points.size(), inside.data());
    }
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const noexcept override {
        auto* first = reinterpret_cast<echinus_contact*>(contacts.data());
        custom_.contacts(custom_.context, floats(points), points.size(), margin, first);
        for (std::size_t i = 0; i < contacts.size(); ++i) normalise(first[i]);
    }

  private:
    static const float* floats(std::span<const Vec3f> points) {
        return reinterpret_cast<const float*>(points.data());
    }
    /// Changes values to those that are valid in C++: flags of 0 or 1, and an existing feature.
    static void normalise(echinus_contact& contact) {
        contact.inside = contact.inside != 0 ? 1 : 0;
        contact.certain = contact.certain != 0 ? 1 : 0;
        if (contact.feature > ECHINUS_FEATURE_VERTEX) contact.feature = ECHINUS_FEATURE_UNKNOWN;
    }

    echinus_custom_map custom_;
    Release release_;
};

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_map_from_custom(const echinus_custom_map* custom, echinus_map** map) {
    if (map != nullptr) *map = nullptr;
    return guarded(__func__, [&] {
        at(map, "the place for the result");
        const auto given = read_struct(custom, echinus_custom_map{}, "custom");
        require(given.contains != nullptr, "custom.contains is NULL");
        require(given.contacts != nullptr, "custom.contacts is NULL");
        const auto functions = std::make_shared<MapOfFunctions>(given);
        *map = new echinus_map{std::shared_ptr<const CustomMap>(functions)};
        functions->arm();
    });
}
