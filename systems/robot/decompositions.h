#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "systems/robot/vectors.h"

/// Eigen's decompositions. Each takes seconds to compile, so those of matrices that many sources decompose
/// are compiled once, in decompositions.cpp. They are called as ever, and others are compiled as ever.
namespace Eigen {

extern template LLT<flinch::PlatformMatrix>& LLT<flinch::PlatformMatrix>::compute(
    const EigenBase<flinch::PlatformMatrix>&);
extern template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);

extern template LDLT<flinch::PlatformMatrix>& LDLT<flinch::PlatformMatrix>::compute(
    const EigenBase<flinch::PlatformMatrix>&);
extern template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);

extern template void PartialPivLU<flinch::PlatformMatrix>::compute();
extern template void PartialPivLU<Matrix<double, 6, 6>>::compute();
extern template void PartialPivLU<MatrixXd>::compute();

extern template void ColPivHouseholderQR<MatrixXd>::computeInPlace();

extern template SelfAdjointEigenSolver<flinch::PlatformMatrix>&
SelfAdjointEigenSolver<flinch::PlatformMatrix>::compute(const EigenBase<flinch::PlatformMatrix>&, int);
extern template SelfAdjointEigenSolver<Matrix<double, 6, 6>>&
SelfAdjointEigenSolver<Matrix<double, 6, 6>>::compute(const EigenBase<Matrix<double, 6, 6>>&, int);
extern template SelfAdjointEigenSolver<Matrix2d>& SelfAdjointEigenSolver<Matrix2d>::compute(
    const EigenBase<Matrix2d>&, int);
extern template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
extern template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);

extern template JacobiSVD<MatrixXd>& JacobiSVD<MatrixXd>::compute(const MatrixXd&, unsigned int);
extern template JacobiSVD<Matrix3d>& JacobiSVD<Matrix3d>::compute(const Matrix3d&, unsigned int);

}  // namespace Eigen
