# BulletFloat64::Collision: Bullet's collision detection in double precision (BulletCollision, LinearMath).
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(PC_BULLET QUIET bullet-float64)
endif()
find_path(BulletFloat64_INCLUDE_DIR btBulletCollisionCommon.h
          HINTS ${PC_BULLET_INCLUDE_DIRS} PATH_SUFFIXES bullet)
foreach(part IN ITEMS BulletCollision LinearMath)
  find_library(BulletFloat64_${part} ${part}-float64 HINTS ${PC_BULLET_LIBRARY_DIRS})
endforeach()
mark_as_advanced(BulletFloat64_INCLUDE_DIR BulletFloat64_BulletCollision BulletFloat64_LinearMath)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletFloat64 REQUIRED_VARS
  BulletFloat64_BulletCollision BulletFloat64_LinearMath BulletFloat64_INCLUDE_DIR)

if(BulletFloat64_FOUND AND NOT TARGET BulletFloat64::Collision)
  add_library(BulletFloat64::Collision INTERFACE IMPORTED)
  set_target_properties(BulletFloat64::Collision PROPERTIES
    INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION
    INTERFACE_INCLUDE_DIRECTORIES ${BulletFloat64_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES "${BulletFloat64_BulletCollision};${BulletFloat64_LinearMath}")
endif()
