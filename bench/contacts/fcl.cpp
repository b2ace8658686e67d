#include "rivals/fcl.hpp"

#include "contacts/system.hpp"

using namespace echinus;

namespace {

class FclContacts : public ContactsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<FclRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }
    std::vector<ContactsWay> ways(std::size_t point_count) override {
        return {
            depth_normal_way("nearest face and its side", point_count, [this](auto points, auto contacts) {
                for (std::size_t i = 0; i < points.size(); ++i) contacts[i] = rival_->contact(points[i]);
            })};
    }

  private:
    std::unique_ptr<FclRival> rival_;
};

} // namespace

void list_fcl(ContactsList& list) {
    list.push_back(listed<FclContacts, ContactsSystem>("FCL", Role::Rival, false));
}
