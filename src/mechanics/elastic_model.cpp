#include "mechanics/elastic_model.hpp"

#include <utility>

namespace echinus {

ElasticModel::ElasticModel(const ElasticParts& parts)
    : particle_count_(parts.masses.size()), membrane_(parts.triangles, particle_count_),
      bending_(parts.hinges, particle_count_), springs_(parts.springs, particle_count_),
      tetrahedra_(parts.tetrahedra, particle_count_), pressure_(parts.pressed, particle_count_) {}

BlockMatrix ElasticModel::pattern() const {
    std::vector<Coupling> blocks, multiples;
    membrane_.couple(blocks);
    bending_.couple(blocks, multiples);
    springs_.couple(blocks);
    tetrahedra_.couple(blocks);
    BlockMatrix matrix;
    matrix.set_pattern(particle_count_, std::move(blocks), std::move(multiples));
    return matrix;
}

void ElasticModel::find_entries(const BlockMatrix& matrix) {
    membrane_.find_entries(matrix);
    bending_.find_entries(matrix);
    springs_.find_entries(matrix);
    tetrahedra_.find_entries(matrix);
}

void ElasticModel::begin_step(Places places, double step) {
    membrane_.begin_step(places, step);
    bending_.begin_step(places, step);
    springs_.begin_step(places, step);
    tetrahedra_.begin_step(places, step);
    pressure_.begin_step(places);
}

double ElasticModel::energy(Places places, const Workers& workers) const {
    return membrane_.energy(places, workers) + bending_.energy(places, workers) +
           springs_.energy(places, workers) + tetrahedra_.energy(places, workers) +
           pressure_.energy(places, workers);
}

void ElasticModel::add_derivatives(Places places, std::span<Vec3d> gradient, BlockMatrix* hessian,
                                   const Workers& workers) const {
    membrane_.add_derivatives(places, gradient, hessian, workers);
    bending_.add_derivatives(places, gradient, hessian, workers);
    springs_.add_derivatives(places, gradient, hessian, workers);
    tetrahedra_.add_derivatives(places, gradient, hessian, workers);
    pressure_.add_gradient(places, gradient, workers);
}

} // namespace echinus
