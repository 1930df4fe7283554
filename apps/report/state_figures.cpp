// SPDX-License-Identifier: BSD-3-Clause
#include "report/state_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vsb/physics/linear_elastic.hpp>
#include <vsb/physics/plastic_strain.hpp>
#include <vsb/physics/principal_stresses.hpp>

namespace vsb::app {

namespace {

using Tensor = SymmetricTensor<3, double>;

Tensor tensor(const std::vector<double>& components, size_t p) {
  Tensor t;
  for (int c = 0; c < Tensor::size; ++c) t[c] = components[6 * p + static_cast<size_t>(c)];
  return t;
}

double length(const double* v) {
  return std::hypot(v[0], v[1], v[2]);
}

/// s : C^-1 : s / 2.
double elastic_energy_density(const LinearElastic<double>& elastic, const Tensor& s) {
  const auto strain = elastic.strain_of(s);
  double twice = 0;
  for (int c = 0; c < Tensor::size; ++c) twice += (c < 3 ? 1 : 2) * s[c] * strain[c];
  return 0.5 * twice;
}

/// With the stress tau = J sigma in a volume V0 = V / J; rate forms make no difference between the two.
double strain_energy(const BodySpec& body, const LinearElastic<double>& elastic, const Tensor& s,
                     double volume, double mass) {
  const double J = body.material.law == MaterialLaw::hencky ? volume * body.density / mass : 1;
  return volume * J * elastic_energy_density(elastic, s);
}

}  // namespace

StateFigures state_figures(const Scene& scene, const ParticleReader& particles) {
  std::vector<LinearElastic<double>> elastic;
  for (const auto& body : scene.bodies)
    elastic.push_back(
        LinearElastic<double>::from_young(body.material.youngs_modulus, body.material.poisson_ratio));
  StateFigures f{0, 0, 0, 0, 0, 0, 0};
  f.largest_principal_stress = -std::numeric_limits<double>::infinity();
  f.smallest_principal_stress = std::numeric_limits<double>::infinity();
  const unsigned fields = field::initial_position | field::position | field::velocity | field::cauchy_stress |
                          field::volume | field::mass;
  size_t b = 0;  // particles come body after body
  particles.for_each_range(fields, [&](const Snapshot& s) {
    for (size_t p = 0; p < s.count(); ++p) {
      while (b + 1 < s.bodies.size() && s.first + p >= static_cast<size_t>(s.bodies[b].last)) ++b;
      double moved[3];
      for (size_t i = 0; i < 3; ++i) moved[i] = s.position[3 * p + i] - s.initial_position[3 * p + i];
      f.largest_displacement = std::max(f.largest_displacement, length(moved));
      const double speed = length(&s.velocity[3 * p]);
      f.kinetic_energy += 0.5 * s.mass[p] * speed * speed;
      const Tensor stress = tensor(s.cauchy_stress, p);
      f.strain_energy += strain_energy(scene.bodies[b], elastic[b], stress, s.volume[p], s.mass[p]);
      const auto principal = principal_stresses(stress).value;
      for (int i = 0; i < 3; ++i) {
        f.largest_principal_stress = std::max(f.largest_principal_stress, principal[i]);
        f.smallest_principal_stress = std::min(f.smallest_principal_stress, principal[i]);
      }
      f.largest_von_mises =
          std::max(f.largest_von_mises, std::sqrt(3 * second_invariant(stress, mean_stress(stress))));
      if (!s.plastic_strain.empty())
        f.largest_equivalent_plastic_strain =
            std::max(f.largest_equivalent_plastic_strain,
                     equivalent_plastic_deviatoric_strain(tensor(s.plastic_strain, p)));
    }
  });
  return f;
}

std::vector<std::pair<std::string, double>> named(const StateFigures& f, const Scene& scene) {
  std::vector<std::pair<std::string, double>> figures = {
      {"largest_displacement", f.largest_displacement},
      {"kinetic_energy", f.kinetic_energy},
      {"strain_energy", f.strain_energy},
      {"largest_principal_stress", f.largest_principal_stress},
      {"smallest_principal_stress", f.smallest_principal_stress},
      {"largest_von_mises", f.largest_von_mises}};
  if (std::any_of(scene.bodies.begin(), scene.bodies.end(),
                  [](const BodySpec& b) { return is_plastic(b.material.law); }))
    figures.emplace_back("largest_equivalent_plastic_strain", f.largest_equivalent_plastic_strain);
  return figures;
}

/// The share of the particles' kinetic energy in the nodes' below which the two are told apart.
constexpr double small_share = 0.01;

void print_state_figures(const StateFigures& f, double energy_ratio) {
  const bool cancels = f.strain_energy > 0 && energy_ratio * f.strain_energy < small_share * f.kinetic_energy;
  fmt::print(
      "of the particles: largest displacement {:.4g} m; principal stresses {:.4g} to {:.4g} Pa, von Mises "
      "stress up to {:.4g} Pa; strain energy {:.4g} J, kinetic energy {:.4g} J{}\n",
      f.largest_displacement, f.smallest_principal_stress, f.largest_principal_stress, f.largest_von_mises,
      f.strain_energy, f.kinetic_energy,
      cancels ? ", in velocities that cancel at the nodes and move nothing" : "");
}

}  // namespace vsb::app
