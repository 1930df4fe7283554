// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The stiffness matrix of the particles at small strain, which is never stored: its product with nodal
/// displacements u, and its blocks on the diagonal,
///   (K u)_I = sum_p V_p (C : sym G_p) . grad N_Ip,   G_p = sum_J u_J (x) grad N_Jp,
///   K_II . e_j = sum_p V_p (C : sym (e_j (x) grad N_Ip)) . grad N_Ip.
/// Against volumetric locking a mean replaces the divergence of G_p (physics/mean_divergence.hpp); K stays
/// symmetric. The blocks, which serve as preconditioner, are without the mean.
///
/// Reads positions and volumes of the particles and nodal displacements; writes nodal vectors or blocks.
#pragma once

#include <vector>
#include <vsb/kernels/particles/mirror_nodes.hpp>
#include <vsb/kernels/particles/scatter.hpp>
#include <vsb/kernels/particles/update_stress.hpp>

namespace vsb {

namespace kernel {

/// What the particles first, ..., last - 1 of one material add to K u.
template <class Basis, int Dim, class Real, class Device>
struct StiffnessForce {
  static constexpr int columns = Dim;
  Particles<Dim, Real, Device> particles;
  Basis basis;
  LinearElastic<Real> material;
  int first, last;
  typename Nodes<Dim, Real, Device>::Fields displacement;  ///< [node][Dim], m
  typename MeanDivergence<Real, Device>::Numbers mean;     ///< [particle]: thetabar, where beta is not 0
  Real beta;

  template <class Sink>
  KOKKOS_FUNCTION void operator()(int p, const Sink& sink) const {
    if (p < first || p >= last) return;
    const auto shape = basis.shape(particles.position_of(p));
    auto G = shape.gradient(displacement);
    if (beta > Real(0)) G = with_mean_divergence(G, mean(p), beta);
    const auto sigma = material.strained(SymmetricTensor<Dim, Real>::zero(), G, Real(1));
    const Real V = particles.volume(p);
    for (int a = 0; a < Basis::support; ++a) {
      const auto f = V * (sigma * shape.dN[a]);
      for (int i = 0; i < Dim; ++i) sink(a, shape.node[a], i) += f[i];
    }
  }
};

/// What the same particles add to the blocks K_II, entry (i, j) in column i Dim + j.
template <class Basis, int Dim, class Real, class Device>
struct StiffnessBlock {
  static constexpr int columns = Dim * Dim;
  Particles<Dim, Real, Device> particles;
  Basis basis;
  LinearElastic<Real> material;
  int first, last;

  template <class Sink>
  KOKKOS_FUNCTION void operator()(int p, const Sink& sink) const {
    if (p < first || p >= last) return;
    const auto shape = basis.shape(particles.position_of(p));
    const Real V = particles.volume(p);
    for (int a = 0; a < Basis::support; ++a)
      for (int j = 0; j < Dim; ++j) {
        auto G = Matrix<Dim, Real>::zero();
        for (int k = 0; k < Dim; ++k) G(j, k) = shape.dN[a][k];
        const auto f = V * (material.strained(SymmetricTensor<Dim, Real>::zero(), G, Real(1)) * shape.dN[a]);
        for (int i = 0; i < Dim; ++i) sink(a, shape.node[a], i * Dim + j) += f[i];
      }
  }
};

/// sum <- sum + term.
template <class Fields>
struct AddNodalSums {
  Fields sum, term;
  KOKKOS_FUNCTION void operator()(int I) const {
    for (size_t c = 0; c < sum.extent(1); ++c) sum(I, c) += term(I, c);
  }
};

}  // namespace kernel

/// The matrix K of particles where they are; their bins must be up to date.
template <class Basis, int Dim, class Real, class Device>
class Stiffness {
 public:
  using Fields = typename Nodes<Dim, Real, Device>::Fields;  ///< one row per node

  /// Of all bodies at the present positions, by the small-strain law of their materials. Sums are made by
  /// `strategy`. With Volumetric::averaged a mean replaces the divergence, as in steps. The object holds
  /// Views of the caller's data, no copies.
  Stiffness(const Particles<Dim, Real, Device>& particles, const std::vector<Body<Real>>& bodies,
            const Basis& basis, const ParticleBins<Device>& bins, Scatter strategy,
            Volumetric volumetric = Volumetric::full)
      : particles_(particles),
        bodies_(bodies),
        basis_(basis),
        bins_(bins),
        strategy_(strategy),
        volumetric_(volumetric) {}

  /// force <- K u. Both are [node][Dim]. Prescribed components are treated like all others. Ghost nodes take
  /// the displacements of their images before the sum; their forces are added to those of the images after
  /// it.
  template <class Exec>
  void apply(const Exec& exec, const Fields& u, const Fields& force) {
    mirror_vectors(exec, basis_, u);
    average(exec, u);
    sum_over_bodies(exec, "vsb::stiffness_force", force_workspace_, force,
                    [&](const LinearElastic<Real>& material, int first, int last) {
                      return kernel::StiffnessForce<Basis, Dim, Real, Device>{
                          particles_, basis_, material,          first,
                          last,       u,      mean_.of_particle, share_of<Dim>(mean_, material)};
                    });
    fold_ghost_nodes(exec, basis_, force, 0);
  }

  /// block <- K_II, [node][Dim x Dim]. At the image of a ghost node: the sum of both blocks, without the
  /// coupling of the two nodes.
  template <class Exec>
  void diagonal_blocks(const Exec& exec, const Fields& block) {
    ScatterWorkspace<Real, Device> workspace;
    sum_over_bodies(
        exec, "vsb::stiffness_block", workspace, block,
        [&](const LinearElastic<Real>& material, int first, int last) {
          return kernel::StiffnessBlock<Basis, Dim, Real, Device>{particles_, basis_, material, first, last};
        });
    fold_ghost_nodes(exec, basis_, block, Dim * Dim);
  }

  /// The mean divergence of the displacements u; empty unless the stiffness averages.
  template <class Exec>
  const MeanDivergence<Real, Device>& average(const Exec& exec, const Fields& u) {
    if (volumetric_ == Volumetric::averaged)
      average_divergence(exec, particles_, bins_, u, bodies_, basis_, mean_, strategy_);
    return mean_;
  }

 private:
  template <class Exec, class Contribution>
  void sum_over_bodies(const Exec& exec, const std::string& label, ScatterWorkspace<Real, Device>& workspace,
                       const Fields& target, const Contribution& contribution) {
    Kokkos::deep_copy(exec, target, Real(0));
    if (bodies_.size() > 1 && (term_.extent(0) != target.extent(0) || term_.extent(1) != target.extent(1)))
      term_ = Fields("vsb::stiffness_of_body", target.extent(0), target.extent(1));
    for (const auto& body : bodies_) {
      const Fields& sums = bodies_.size() > 1 ? term_ : target;
      scatter(exec, label, strategy_, particles_.count(), basis_, bins_, workspace,
              contribution(small_strain_law(body.material), body.first, body.last), sums);
      if (bodies_.size() > 1)
        Kokkos::parallel_for("vsb::add_stiffness_of_body",
                             Kokkos::RangePolicy<Exec>(exec, 0, static_cast<int>(target.extent(0))),
                             kernel::AddNodalSums<Fields>{target, term_});
    }
  }

  Particles<Dim, Real, Device> particles_;
  std::vector<Body<Real>> bodies_;
  Basis basis_;
  ParticleBins<Device> bins_;
  Scatter strategy_;
  Volumetric volumetric_;
  MeanDivergence<Real, Device> mean_;
  ScatterWorkspace<Real, Device> force_workspace_;
  Fields term_;  ///< sums of one body, where there are several
};

}  // namespace vsb
