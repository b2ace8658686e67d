#include "contacts/system.hpp"
#include "rivals/vdb.hpp"

using namespace echinus;

namespace {

class NanoVdbContacts : public ContactsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<NanoVdbRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }
    std::vector<ContactsWay> ways(std::size_t point_count) override {
        return {depth_normal_way("trilinear with gradient", point_count,
                                 [this](auto points, auto contacts) { rival_->contacts(points, contacts); })};
    }

  private:
    std::unique_ptr<NanoVdbRival> rival_;
};

} // namespace

void list_nanovdb(ContactsList& list) {
    list.push_back(listed<NanoVdbContacts, ContactsSystem>("NanoVDB 2R/200", Role::Rival, false));
}
