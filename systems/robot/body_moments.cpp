#include "systems/robot/body_moments.h"

#include <array>

namespace flinch {
namespace {

Eigen::Matrix3d inertia_of(const BodyMoments& m) {
  Eigen::Matrix3d I;
  I << m[4], m[7], m[8], m[7], m[5], m[9], m[8], m[9], m[6];
  return I;
}

}  // namespace

BodyMoments moments_of(const RigidBodyInertia& body) {
  const Eigen::Matrix3d I = about_origin(body);
  BodyMoments moments;
  moments << body.mass, body.mass * body.centre_of_mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2);
  return moments;
}

RigidBodyInertia body_of(const BodyMoments& moments) {
  RigidBodyInertia body;
  body.mass = moments[0];
  body.centre_of_mass = moments.segment<3>(1) / moments[0];
  const Eigen::Matrix3d S = cross_matrix(body.centre_of_mass);
  body.inertia = inertia_of(moments) + body.mass * S * S;
  return body;
}

const char* moment_name(int index) {
  static constexpr std::array names = {"mass", "first_moment_x", "first_moment_y", "first_moment_z", "I_xx",
                                       "I_yy", "I_zz",           "I_xy",           "I_xz",           "I_yz"};
  return names[static_cast<std::size_t>(index)];
}

const char* moment_unit(int index) { return index == 0 ? "kg" : index < 4 ? "kg m" : "kg m^2"; }

Eigen::Matrix4d pseudo_inertia(const BodyMoments& moments) {
  const Eigen::Matrix3d I = inertia_of(moments);
  Eigen::Matrix4d pseudo;
  pseudo.topLeftCorner<3, 3>() = 0.5 * I.trace() * Eigen::Matrix3d::Identity() - I;
  pseudo.topRightCorner<3, 1>() = moments.segment<3>(1);
  pseudo.bottomLeftCorner<1, 3>() = moments.segment<3>(1).transpose();
  pseudo(3, 3) = moments[0];
  return pseudo;
}

// I_zz > (first moments)^2 / mass.
Eigen::Matrix3d planar_pseudo_inertia(const BodyMoments& moments) {
  Eigen::Matrix3d pseudo = moments[0] * Eigen::Matrix3d::Identity();
  pseudo(0, 0) = moments[6];
  pseudo.bottomLeftCorner<2, 1>() = moments.segment<2>(1);
  pseudo.topRightCorner<1, 2>() = moments.segment<2>(1).transpose();
  return pseudo;
}

std::vector<FileValue> body_in_file(const std::string& path, const RigidBodyInertia& body) {
  std::vector<FileValue> told = {{path + ".mass_kg", "kg", body.mass, {}}};
  const auto add = [&](const std::string& key, const char* unit, const Eigen::Vector3d& values) {
    for (int i = 0; i < 3; ++i)
      told.push_back({path + "." + key + "[" + std::to_string(i) + "]", unit, values[i], {}});
  };
  add("centre_of_mass_m", "m", body.centre_of_mass);
  add("inertia_kg_m2", "kg m^2", body.inertia.diagonal());
  add("inertia_products_kg_m2", "kg m^2", {body.inertia(0, 1), body.inertia(0, 2), body.inertia(1, 2)});
  return told;
}

}  // namespace flinch
