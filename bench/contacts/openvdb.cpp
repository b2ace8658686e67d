#include "contacts/system.hpp"
#include "rivals/vdb.hpp"

using namespace echinus;

namespace {

class OpenVdbContacts : public ContactsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<OpenVdbRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }
    std::vector<ContactsWay> ways(std::size_t point_count) override {
        return {depth_normal_way("trilinear with gradient", point_count,
                                 [this](auto points, auto contacts) { rival_->contacts(points, contacts); })};
    }

  private:
    std::unique_ptr<OpenVdbRival> rival_;
};

} // namespace

void list_openvdb(ContactsList& list) {
    list.push_back(listed<OpenVdbContacts, ContactsSystem>("OpenVDB 2R/200", Role::Rival, false));
}
