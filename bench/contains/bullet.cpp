#include "rivals/bullet.hpp"

#include "contains/system.hpp"

using namespace echinus;

namespace {

class BulletContains : public ContainsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<BulletRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }
    std::vector<ContainsWay> ways() override {
        return {{"first hit", [this](auto points, auto inside) {
                     for (std::size_t i = 0; i < points.size(); ++i) inside[i] = rival_->inside(points[i]);
                 }}};
    }

  private:
    std::unique_ptr<BulletRival> rival_;
};

} // namespace

void list_bullet(ContainsList& list) {
    list.push_back(listed<BulletContains, ContainsSystem>("Bullet", Role::Rival, false));
}
