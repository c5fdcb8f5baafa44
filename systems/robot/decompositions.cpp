#include "systems/robot/decompositions.h"

namespace Eigen {

template LLT<flinch::PlatformMatrix>& LLT<flinch::PlatformMatrix>::compute(
    const EigenBase<flinch::PlatformMatrix>&);
template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);

template LDLT<flinch::PlatformMatrix>& LDLT<flinch::PlatformMatrix>::compute(
    const EigenBase<flinch::PlatformMatrix>&);
template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);

template void PartialPivLU<flinch::PlatformMatrix>::compute();
template void PartialPivLU<Matrix<double, 6, 6>>::compute();
template void PartialPivLU<MatrixXd>::compute();

template void ColPivHouseholderQR<MatrixXd>::computeInPlace();

template SelfAdjointEigenSolver<flinch::PlatformMatrix>&
SelfAdjointEigenSolver<flinch::PlatformMatrix>::compute(const EigenBase<flinch::PlatformMatrix>&, int);
template SelfAdjointEigenSolver<Matrix<double, 6, 6>>& SelfAdjointEigenSolver<Matrix<double, 6, 6>>::compute(
    const EigenBase<Matrix<double, 6, 6>>&, int);
template SelfAdjointEigenSolver<Matrix2d>& SelfAdjointEigenSolver<Matrix2d>::compute(
    const EigenBase<Matrix2d>&, int);
template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);

template JacobiSVD<MatrixXd>& JacobiSVD<MatrixXd>::compute(const MatrixXd&, unsigned int);
template JacobiSVD<Matrix3d>& JacobiSVD<Matrix3d>::compute(const Matrix3d&, unsigned int);

}  // namespace Eigen
