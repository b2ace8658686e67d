#include "rivals/fcl.hpp"

#include "contains/system.hpp"

using namespace echinus;

namespace {

class FclContains : public ContainsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<FclRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }
    std::vector<ContainsWay> ways() override {
        return {{"side of the nearest face", [this](auto points, auto inside) {
                     for (std::size_t i = 0; i < points.size(); ++i)
                         inside[i] = rival_->contact(points[i]).depth > 0;
                 }}};
    }

  private:
    std::unique_ptr<FclRival> rival_;
};

} // namespace

void list_fcl(ContainsList& list) {
    list.push_back(listed<FclContains, ContainsSystem>("FCL", Role::Rival, false));
}
