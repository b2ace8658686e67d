#include "rivals/embree.hpp"

#include "contains/system.hpp"

using namespace echinus;

namespace {

class EmbreeContains : public ContainsSystem {
  public:
    void build(const TriangleMesh& mesh) override { rival_ = std::make_unique<EmbreeRival>(mesh); }
    std::size_t byte_count() const override { return rival_->byte_count(); }
    std::vector<ContainsWay> ways() override {
        return {{"first hit", [this](auto points, auto inside) { rival_->first_hits(points, inside); }},
                {"first hit packets of 16",
                 [this](auto points, auto inside) { rival_->first_hits_by_packets(points, inside); }},
                {"parity", [this](auto points, auto inside) { rival_->parities(points, inside); }},
                {"parity packets of 16",
                 [this](auto points, auto inside) { rival_->parities_by_packets(points, inside); }}};
    }

  private:
    std::unique_ptr<EmbreeRival> rival_;
};

} // namespace

void list_embree(ContainsList& list) {
    list.push_back(listed<EmbreeContains, ContainsSystem>("Embree", Role::Rival, true));
}
