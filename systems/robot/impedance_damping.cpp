#include "systems/robot/impedance_damping.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace flinch {
namespace {

using Eigensystem = Eigen::SelfAdjointEigenSolver<PlatformMatrix>;

// Rounding makes the zero eigenvalues of a semi-definite matrix slightly negative.
PlatformVector roots(const PlatformVector& eigenvalues) { return eigenvalues.cwiseMax(0.0).cwiseSqrt(); }

PlatformMatrix symmetric_root(const PlatformMatrix& matrix) {
  const Eigensystem system(matrix);
  const PlatformMatrix& V = system.eigenvectors();
  return V * roots(system.eigenvalues()).asDiagonal() * V.transpose();
}

bool positive_definite(const PlatformMatrix& symmetric) {
  return Eigen::LLT<PlatformMatrix>(symmetric).info() == Eigen::Success;
}

bool admissible(const PlatformMatrix& M, const PlatformMatrix& K, const PlatformVector& xi) {
  const Eigen::Index n = M.rows();
  const bool sizes = n > 0 && M.cols() == n && K.rows() == n && K.cols() == n && xi.size() == n;
  return sizes && M.allFinite() && K.allFinite() && xi.allFinite() && positive_definite(M);
}

}  // namespace

PlatformMatrix factorisation_damping(const PlatformMatrix& M, const PlatformMatrix& K,
                                     const PlatformVector& xi) noexcept {
  const PlatformMatrix half = symmetric_root(M) * xi.asDiagonal() * symmetric_root(K);
  return half + half.transpose();
}

// With M = L L^T the eigenvectors of L^-1 K L^-T are V = L^T W, so that M W = L V.
PlatformMatrix modal_damping(const PlatformMatrix& M, const PlatformMatrix& K,
                             const PlatformVector& xi) noexcept {
  const PlatformMatrix L = Eigen::LLT<PlatformMatrix>(M).matrixL();
  PlatformMatrix scaled = L.triangularView<Eigen::Lower>().solve(K);
  scaled = L.triangularView<Eigen::Lower>().solve(PlatformMatrix(scaled.transpose()));
  const Eigensystem modes(scaled);
  const PlatformMatrix M_W = L * modes.eigenvectors();
  const PlatformVector modal = 2.0 * xi.cwiseProduct(roots(modes.eigenvalues()));
  return M_W * modal.asDiagonal() * M_W.transpose();
}

ImpedanceDamping impedance_damping(const PlatformMatrix& M, const PlatformMatrix& K,
                                   const PlatformVector& xi) noexcept {
  if (!admissible(M, K, xi)) return {PlatformMatrix::Zero(M.rows(), M.rows()), DampingDesign::none};
  ImpedanceDamping damping{factorisation_damping(M, K, xi), DampingDesign::factorisation};
  if (positive_definite(damping.D)) return damping;
  return {modal_damping(M, K, xi), DampingDesign::generalised_eigenvalue};
}

}  // namespace flinch
