#pragma once

#include <Eigen/Core>

#include "systems/robot/vectors.h"

/// Small convex quadratic programmes, solved within a tick: no allocation, a bounded number of steps, and a
/// result by value.
namespace flinch {

/// Largest number of variables: the drives, and one slack.
inline constexpr int max_variables = max_dof + 1;
/// Largest number of constraints.
inline constexpr int max_constraints = 72;

using ProgrammeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_variables, 1>;
using ProgrammeMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_variables, max_variables>;

/// minimise z^T H z / 2 + f^T z   subject to   C z >= d, row by row.
struct QuadraticProgramme {
  using Rows =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, max_constraints, max_variables>;
  using Bounds = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_constraints, 1>;

  ProgrammeMatrix H;  ///< symmetric, positive definite
  ProgrammeVector f;
  Rows C;
  Bounds d;
};

/// A minimum, or why there is none.
struct ProgrammeSolution {
  enum class Status {
    solved,
    infeasible,      ///< no z fulfils all constraints
    too_many_steps,  ///< the bound on steps was reached: z fulfils some constraints only
    refused,         ///< sizes do not fit, an entry is not finite, or H is not positive definite
  };

  Status status = Status::refused;
  ProgrammeVector z;                       ///< zero where refused
  QuadraticProgramme::Bounds multipliers;  ///< of the constraints, none negative: H z + f = C^T multipliers
  int steps = 0;                           ///< constraints that were taken up or dropped

  bool solved() const { return status == Status::solved; }
};

/// Solves by the dual method of Goldfarb and Idnani (Mathematical Programming 27, 1983): from the minimum
/// without constraints, takes up the most violated one after another and drops those that hold it back.
/// Rows of zeros are allowed. Beyond `most_steps` it gives up.
ProgrammeSolution solve(const QuadraticProgramme& programme, int most_steps = 60) noexcept;

}  // namespace flinch
