#include "contains/system.hpp"
#include "rivals/vdb.hpp"

using namespace echinus;

namespace {

class OpenVdbContains : public ContainsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<OpenVdbRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }
    std::vector<ContainsWay> ways() override {
        return {{"trilinear", [this](auto points, auto inside) { rival_->contains(points, inside); }}};
    }

  private:
    std::unique_ptr<OpenVdbRival> rival_;
};

} // namespace

void list_openvdb(ContainsList& list) {
    list.push_back(listed<OpenVdbContains, ContainsSystem>("OpenVDB 2R/200", Role::Rival, false));
}
