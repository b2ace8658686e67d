#include "rivals/cgal.hpp"

#include "contacts/system.hpp"

using namespace echinus;

namespace {

class CgalContacts : public ContactsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<CgalRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }
    std::vector<ContactsWay> ways(std::size_t point_count) override {
        return {depth_normal_way("side then nearest", point_count, [this](auto points, auto contacts) {
            for (std::size_t i = 0; i < points.size(); ++i) contacts[i] = contact(points[i]);
        })};
    }

  private:
    DepthNormal contact(const Vec3f& point) const {
        if (!rival_->inside(point)) return {};
        const Vec3d way_out = rival_->nearest(point) - Vec3d(point);
        const double depth = length(way_out);
        return {static_cast<float>(depth), Vec3f(way_out * (1 / depth))};
    }

    std::unique_ptr<CgalRival> rival_;
};

} // namespace

void list_cgal(ContactsList& list) {
    list.push_back(listed<CgalContacts, ContactsSystem>("CGAL", Role::Rival, false));
}
