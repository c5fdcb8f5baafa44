#include "systems/robot/impedance_damping.h"

#include <cmath>

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

template <class Matrix>
using Eigensystem = Eigen::SelfAdjointEigenSolver<Matrix>;

// Rounding makes the zero eigenvalues of a semi-definite matrix slightly negative.
template <class Vector>
Vector roots(const Vector& eigenvalues) {
  return eigenvalues.cwiseMax(0.0).cwiseSqrt();
}

template <class Matrix>
Matrix symmetric_root(const Matrix& S) {
  if (S.isDiagonal(0.0)) return roots(S.diagonal().eval()).asDiagonal();
  const Eigensystem<Matrix> system(S);
  const Matrix& V = system.eigenvectors();
  return V * roots(system.eigenvalues()).asDiagonal() * V.transpose();
}

PlatformMatrix definite_root(const PlatformMatrix& M) { return symmetric_root(M); }

// With the invariants of the root U, by Cayley and Hamilton U^2 = I U - II + III U^-1 (Hoger, Carlson 1984),
// (I II - III) U = I III 1 + (I^2 - II) M - M^2. The factor is the product of the sums of any two roots of
// eigenvalues of M, so that equal ones do no harm.
Eigen::Matrix3d definite_root(const Eigen::Matrix3d& M) {
  Eigensystem<Eigen::Matrix3d> system;
  const Eigen::Vector3d u = roots(system.computeDirect(M, Eigen::EigenvaluesOnly).eigenvalues().eval());
  const double I = u[0] + u[1] + u[2];
  const double II = u[0] * u[1] + u[1] * u[2] + u[2] * u[0];
  const double III = u[0] * u[1] * u[2];
  return (I * III * Eigen::Matrix3d::Identity() + (I * I - II) * M - M * M) / (I * II - III);
}

template <class Matrix>
bool positive_definite(const Matrix& symmetric) {
  return Eigen::LLT<Matrix>(symmetric).info() == Eigen::Success;
}

bool admissible(const PlatformMatrix& M, const PlatformMatrix& K, const PlatformVector& xi) {
  const Eigen::Index n = M.rows();
  const bool sizes = n > 0 && M.cols() == n && K.rows() == n && K.cols() == n && xi.size() == n;
  return sizes && M.allFinite() && K.allFinite() && xi.allFinite();
}

template <class Matrix, class Vector>
Matrix factorise(const Matrix& M, const Matrix& K, const Vector& xi) {
  const Matrix half = definite_root(M) * xi.asDiagonal() * symmetric_root(K);
  return half + half.transpose();
}

template <class Matrix, class Vector>
ImpedanceDamping design(const Matrix& M, const Matrix& K, const Vector& xi) {
  if (!positive_definite(M)) return {PlatformMatrix::Zero(M.rows(), M.rows()), DampingDesign::none};
  const Matrix D = factorise(M, K, xi);
  if (positive_definite(D)) return {D, DampingDesign::factorisation};
  return {modal_damping(M, K, xi), DampingDesign::generalised_eigenvalue};
}

}  // namespace

// Three coordinates have their own way, without iterations and loops.
PlatformMatrix factorisation_damping(const PlatformMatrix& M, const PlatformMatrix& K,
                                     const PlatformVector& xi) noexcept {
  if (M.rows() == 3) return factorise<Eigen::Matrix3d, Eigen::Vector3d>(M, K, xi);
  return factorise(M, K, xi);
}

// With M = L L^T the eigenvectors of L^-1 K L^-T are V = L^T W, so that M W = L V.
PlatformMatrix modal_damping(const PlatformMatrix& M, const PlatformMatrix& K,
                             const PlatformVector& xi) noexcept {
  const PlatformMatrix L = Eigen::LLT<PlatformMatrix>(M).matrixL();
  PlatformMatrix scaled = L.triangularView<Eigen::Lower>().solve(K);
  scaled = L.triangularView<Eigen::Lower>().solve(PlatformMatrix(scaled.transpose()));
  const Eigensystem<PlatformMatrix> modes(scaled);
  const PlatformMatrix M_W = L * modes.eigenvectors();
  const PlatformVector modal = 2.0 * xi.cwiseProduct(roots(modes.eigenvalues()));
  return M_W * modal.asDiagonal() * M_W.transpose();
}

ImpedanceDamping impedance_damping(const PlatformMatrix& M, const PlatformMatrix& K,
                                   const PlatformVector& xi) noexcept {
  if (!admissible(M, K, xi)) return {PlatformMatrix::Zero(M.rows(), M.rows()), DampingDesign::none};
  if (M.rows() == 3) return design<Eigen::Matrix3d, Eigen::Vector3d>(M, K, xi);
  return design(M, K, xi);
}

}  // namespace flinch
