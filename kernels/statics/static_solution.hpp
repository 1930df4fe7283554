// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The static state of linear elastic particles at small strain: nodal displacements u with
///   K u = f,   K as in kernels/statics/stiffness.hpp,   f_I of kernels/particles/assemble_forces.hpp,
/// where f contains the loads, the weight and the initial stress of the particles at their initial positions.
/// The solution gives
///   sigma_p <- sigma_p + C : sym sum_I u_I (x) grad N_Ip,   x_p <- x_p + sum_I N_Ip u_I,
/// with the mean divergence where K has it. Volumes and the directions of an initial stress are not changed:
/// the error is of the order of the strain.
///
/// The conjugate gradient method, preconditioned by the blocks K_II. Its residual is measured in the norm of
/// the preconditioner, |r|^2 = sum_I r_I . K_II^-1 r_I, relative to |f|. This norm weighs the small force at
/// a node in a nearly empty cell by the displacement that it causes. A free body under loads in balance has
/// many solutions, which differ by rigid motions; starting from u = 0 the method finds one.
#pragma once

#include <vsb/kernels/particles/ordered_sum.hpp>
#include <vsb/kernels/statics/stiffness.hpp>
#include <vsb/physics/explicit_dynamics.hpp>

namespace vsb {

/// When the iteration for the static state ends.
struct StaticOptions {
  double residual = 1e-10;     ///< relative, at which the solution counts as found
  int max_iterations = 20000;  ///< after so many it ends without convergence
};

/// How the iteration ended.
struct StaticResult {
  int iterations;   ///< made
  double residual;  ///< relative
  bool converged;   ///< whether the residual of the options was reached
};

namespace kernel {

/// Replaces K_II by its inverse on the components that can move, and by zero on the others: the prescribed
/// ones, and all of a node without mass or stiffness.
template <int Dim, class Real, class Device>
struct InvertBlock {
  Nodes<Dim, Real, Device> nodes;
  typename Nodes<Dim, Real, Device>::Fields block;

  KOKKOS_FUNCTION void operator()(int I) const {
    Real scale = 0;
    for (int i = 0; i < Dim; ++i) scale += block(I, i * Dim + i);
    const bool idle = !has_mass(nodes.mass(I)) || !(scale > 0);
    const auto fixed = [&](int i) { return idle || (nodes.fixed_components(I) >> i & 1) != 0; };
    auto m = Matrix<Dim, Real>::identity();
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        if (!fixed(i) && !fixed(j)) m(i, j) = block(I, i * Dim + j) / scale;
    const auto inverse_block = inverse(m);
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        block(I, i * Dim + j) = fixed(i) || fixed(j) ? Real(0) : inverse_block(i, j) / scale;
  }
};

/// u <- 0 and r <- f where a component can move (K_II^-1 is not zero), r <- 0 elsewhere.
template <int Dim, class Real, class Device>
struct StartResidual {
  using Fields = typename Nodes<Dim, Real, Device>::Fields;
  Nodes<Dim, Real, Device> nodes;
  Fields inverse_block, u, r;

  KOKKOS_FUNCTION void operator()(int I) const {
    for (int i = 0; i < Dim; ++i) {
      u(I, i) = 0;
      r(I, i) = inverse_block(I, i * Dim + i) > 0 ? nodes.force(I, i) : Real(0);
    }
  }
};

/// z <- K_II^-1 r, and the sum of r . z.
template <int Dim, class Real, class Device>
struct Precondition {
  using Fields = typename Nodes<Dim, Real, Device>::Fields;
  Fields inverse_block, r, z;

  KOKKOS_FUNCTION void operator()(int I, Vector<1, double>& sum) const {
    for (int i = 0; i < Dim; ++i) {
      Real zi = 0;
      for (int j = 0; j < Dim; ++j) zi += inverse_block(I, i * Dim + j) * r(I, j);
      z(I, i) = zi;
      sum[0] += static_cast<double>(r(I, i)) * static_cast<double>(zi);
    }
  }
};

/// The sum of a . b.
template <class Fields>
struct NodalProduct {
  Fields a, b;
  KOKKOS_FUNCTION void operator()(int I, Vector<1, double>& sum) const {
    for (size_t i = 0; i < a.extent(1); ++i)
      sum[0] += static_cast<double>(a(I, i)) * static_cast<double>(b(I, i));
  }
};

/// u <- u + step p,   r <- r - step K p in the components that can move.
template <int Dim, class Real, class Device>
struct AdvanceSolution {
  using Fields = typename Nodes<Dim, Real, Device>::Fields;
  Fields inverse_block, p, Kp, u, r;
  Real step;

  KOKKOS_FUNCTION void operator()(int I) const {
    for (int i = 0; i < Dim; ++i) {
      u(I, i) += step * p(I, i);
      if (inverse_block(I, i * Dim + i) > 0) r(I, i) -= step * Kp(I, i);
    }
  }
};

/// p <- z + beta p.
template <class Fields, class Real>
struct AdvanceDirection {
  Fields z, p;
  Real beta;
  KOKKOS_FUNCTION void operator()(int I) const {
    for (size_t i = 0; i < p.extent(1); ++i) p(I, i) = z(I, i) + beta * p(I, i);
  }
};

/// The sum of the absolute values of the force components.
template <int Dim, class Real, class Device>
struct ForceSize {
  Nodes<Dim, Real, Device> nodes;
  KOKKOS_FUNCTION void operator()(int I, Vector<1, double>& sum) const {
    for (int i = 0; i < Dim; ++i) sum[0] += math::abs(static_cast<double>(nodes.force(I, i)));
  }
};

/// One particle's stress in the static state; the reduction's maximum is the largest strain component.
template <class Basis, int Dim, class Real, class Device>
struct StrainParticle {
  Particles<Dim, Real, Device> particles;
  typename Nodes<Dim, Real, Device>::Fields u;
  Basis basis;
  LinearElastic<Real> material;
  typename MeanDivergence<Real, Device>::Numbers mean;  ///< [particle]: thetabar, where beta is not 0
  Real beta;

  KOKKOS_FUNCTION void operator()(int p, Real& largest) const {
    auto G = basis.shape(particles.position_of(p)).gradient(u);
    if (beta > Real(0)) G = with_mean_divergence(G, mean(p), beta);
    const auto sigma = material.strained(particles.stress_of(p), G, Real(1));
    const auto strain = strain_increment(G, Real(1));
    for (int c = 0; c < SymmetricTensor<Dim, Real>::size; ++c) {
      particles.cauchy_stress(p, c) = sigma[c];
      largest = math::max(largest, math::abs(strain[c]));
    }
  }
};

template <class Basis, int Dim, class Real, class Device>
struct DisplaceParticle {
  Particles<Dim, Real, Device> particles;
  typename Nodes<Dim, Real, Device>::Fields u;
  Basis basis;

  KOKKOS_FUNCTION void operator()(int p) const {
    const auto x = particles.position_of(p);
    const auto displacement = basis.shape(x).interpolate(u);
    for (int i = 0; i < Dim; ++i) particles.position(p, i) = x[i] + displacement[i];
  }
};

}  // namespace kernel

/// The sum of the absolute values of all force components in nodes.sums, N. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
double sum_of_forces(const Exec& exec, const Nodes<Dim, Real, Device>& nodes) {
  return ordered_sum<1, Device>(exec, "vsb::sum_of_forces", nodes.count(),
                                kernel::ForceSize<Dim, Real, Device>{nodes})[0];
}

/// Solves K u = f for the displacements u, [node][Dim] in m. `nodes.sums` must hold the forces and masses of
/// the particles where they are, and `bins` these particles. go_on(iteration, residual) is called before
/// every iteration and may end the search by returning false.
template <class Exec, class Basis, int Dim, class Real, class Device, class GoOn>
StaticResult solve_displacement(const Exec& exec, Stiffness<Basis, Dim, Real, Device>& stiffness,
                                const Nodes<Dim, Real, Device>& nodes,
                                const typename Nodes<Dim, Real, Device>::Fields& u,
                                const StaticOptions& options, const GoOn& go_on) {
  const ProfilingRegion region("vsb::solve_displacement");
  using Fields = typename Nodes<Dim, Real, Device>::Fields;
  const int count = nodes.count();
  const auto n = static_cast<size_t>(count);
  const Kokkos::RangePolicy<Exec> all(exec, 0, count);
  const Fields block("vsb::stiffness_blocks", n, Dim * Dim), r("vsb::residual", n, Dim),
      z("vsb::preconditioned_residual", n, Dim), p("vsb::search_direction", n, Dim),
      Kp("vsb::stiffness_times_direction", n, Dim);
  const auto precondition = [&] {
    return ordered_sum<1, Device>(exec, "vsb::precondition", count,
                                  kernel::Precondition<Dim, Real, Device>{block, r, z})[0];
  };

  stiffness.diagonal_blocks(exec, block);
  Kokkos::parallel_for("vsb::invert_block", all, kernel::InvertBlock<Dim, Real, Device>{nodes, block});
  Kokkos::parallel_for("vsb::start_residual", all,
                       kernel::StartResidual<Dim, Real, Device>{nodes, block, u, r});
  double rz = precondition();
  const double start = math::sqrt(rz);
  Kokkos::deep_copy(exec, p, z);
  StaticResult result{0, start > 0 ? 1.0 : 0.0, !(start > 0)};
  while (!result.converged && result.iterations < options.max_iterations &&
         go_on(result.iterations, result.residual)) {
    stiffness.apply(exec, p, Kp);
    const double pKp =
        ordered_sum<1, Device>(exec, "vsb::nodal_product", count, kernel::NodalProduct<Fields>{p, Kp})[0];
    if (!(pKp > 0)) break;  // a motion without strain, or not a number
    Kokkos::parallel_for(
        "vsb::advance_solution", all,
        kernel::AdvanceSolution<Dim, Real, Device>{block, p, Kp, u, r, static_cast<Real>(rz / pKp)});
    const double before = rz;
    rz = precondition();
    Kokkos::parallel_for("vsb::advance_direction", all,
                         kernel::AdvanceDirection<Fields, Real>{z, p, static_cast<Real>(rz / before)});
    ++result.iterations;
    result.residual = math::sqrt(rz) / start;
    result.converged = result.residual <= options.residual;
  }
  return result;
}

/// Gives the particles the stress of the displacements u, at the positions where u was solved for; `mean` is
/// Stiffness::average(u). Returns the largest strain component, so it waits for the device.
template <class Exec, class Basis, int Dim, class Real, class Device>
double strain_particles(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                        const std::vector<Body<Real>>& bodies, const Basis& basis,
                        const typename Nodes<Dim, Real, Device>::Fields& u,
                        const MeanDivergence<Real, Device>& mean = {}) {
  double largest = 0;
  for (const auto& body : bodies) {
    Real of_body = 0;
    const auto material = small_strain_law(body.material);
    Kokkos::parallel_reduce(
        "vsb::strain_particles", Kokkos::RangePolicy<Exec>(exec, body.first, body.last),
        kernel::StrainParticle<Basis, Dim, Real, Device>{particles, u, basis, material, mean.of_particle,
                                                         share_of<Dim>(mean, material)},
        Kokkos::Max<Real>(of_body));
    exec.fence();
    if (body.last > body.first) largest = math::max(largest, static_cast<double>(of_body));
  }
  return largest;
}

/// Moves the particles by the displacements u.
template <class Exec, class Basis, int Dim, class Real, class Device>
void displace_particles(const Exec& exec, const Particles<Dim, Real, Device>& particles, const Basis& basis,
                        const typename Nodes<Dim, Real, Device>::Fields& u) {
  Kokkos::parallel_for("vsb::displace_particles", Kokkos::RangePolicy<Exec>(exec, 0, particles.count()),
                       kernel::DisplaceParticle<Basis, Dim, Real, Device>{particles, u, basis});
}

}  // namespace vsb
