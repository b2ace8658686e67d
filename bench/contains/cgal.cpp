#include "rivals/cgal.hpp"

#include "contains/system.hpp"

using namespace echinus;

namespace {

class CgalContains : public ContainsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<CgalRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }
    std::vector<ContainsWay> ways() override {
        return {{"side", [this](auto points, auto inside) {
                     for (std::size_t i = 0; i < points.size(); ++i) inside[i] = rival_->inside(points[i]);
                 }}};
    }

  private:
    std::unique_ptr<CgalRival> rival_;
};

} // namespace

void list_cgal(ContainsList& list) {
    list.push_back(listed<CgalContains, ContainsSystem>("CGAL", Role::Rival, false));
}
