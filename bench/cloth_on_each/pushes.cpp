#include "pushes.hpp"

#include <vector>

using namespace echinus;

namespace {

constexpr float kNegligible = 1e-4F; // of the judge's radius

/// Hands questions on, and judges the answers.
class JudgedMap final : public CustomMap {
  public:
    JudgedMap(const CustomMap& asked, const ExactMap& judge, PushCounts& counts)
        : asked_(asked), judge_(judge), counts_(counts) {}

    void contains_batch(std::span<const Vec3f> points,
                        std::span<std::uint8_t> inside) const noexcept override {
        asked_.contains_batch(points, inside);
    }
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const noexcept override {
        asked_.contacts_batch(points, margin, contacts);
        std::vector<Contact> truth(points.size());
        echinus::contacts_batch(judge_.view(), points, 0, truth);
        for (std::size_t i = 0; i < points.size(); ++i)
            if (contacts[i].inside) judge_push(points[i], contacts[i], truth[i].depth);
    }

  private:
    void judge_push(const Vec3f& point, const Contact& contact, float true_depth) const {
        const float push = length(contact.point - point);
        ++counts_.inside;
        if (contact.normal == Vec3f{})
            ++counts_.no_way_out;
        else if (push > 2 * true_depth && push > kNegligible * judge_.view().radius)
            ++counts_.too_far;
    }

    const CustomMap& asked_;
    const ExactMap& judge_;
    PushCounts& counts_;
};

} // namespace

void judge_next_pushes(const Simulation& simulation, const std::shared_ptr<const CustomMap>& asked,
                       const ExactMap& judge, PushCounts& counts) {
    Collider collider = simulation.colliders().front();
    collider.map = std::make_shared<JudgedMap>(*asked, judge, counts);
    Simulation copy(simulation.deformable(), {std::move(collider)}, simulation.options());
    copy.step();
}
