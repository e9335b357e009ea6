#pragma once
/// The direction of a pattern of crests.

#include "src/metrics/field.hpp"

namespace desert_sim {

struct Orientation {
  double crest_deg = 0;  ///< direction along crests or ridges, 0…180
  double coherence = 0;  ///< 0: no direction … 1: all gradients parallel; 0 of a plane field
};

/// From the structure tensor Σ ∇h ∇hᵀ of the field smoothed by a Gaussian of `sigma` metres: its eigenvectors
/// lie across and along the crests, and the coherence is (λ₁ − λ₂) / (λ₁ + λ₂).
Orientation crest_orientation(const Field& relief, double sigma);

}  // namespace desert_sim
