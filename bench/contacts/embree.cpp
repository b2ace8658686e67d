#include "rivals/embree.hpp"

#include "contacts/system.hpp"

using namespace echinus;

namespace {

class EmbreeContacts : public ContactsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<EmbreeRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }

    std::vector<ContactsWay> ways(std::size_t point_count) override {
        inside_.resize(point_count);
        return {depth_normal_way("first hit then point query", point_count,
                                 [this](auto points, auto contacts) {
                                     rival_->first_hits(points, inside_);
                                     find_nearest(points, contacts);
                                 }),
                depth_normal_way("first hit packets of 16 then point query", point_count,
                                 [this](auto points, auto contacts) {
                                     rival_->first_hits_by_packets(points, inside_);
                                     find_nearest(points, contacts);
                                 })};
    }

  private:
    void find_nearest(std::span<const Vec3f> points, std::span<DepthNormal> contacts) const {
        for (std::size_t i = 0; i < points.size(); ++i) {
            contacts[i] = {};
            if (inside_[i] == 0) continue;
            const auto [point, distance] = rival_->nearest(points[i]);
            contacts[i] = {distance, (point - points[i]) * (1 / distance)};
        }
    }

    std::unique_ptr<EmbreeRival> rival_;
    std::vector<std::uint8_t> inside_;
};

} // namespace

void list_embree(ContactsList& list) {
    list.push_back(listed<EmbreeContacts, ContactsSystem>("Embree", Role::Rival, true));
}
