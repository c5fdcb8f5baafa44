#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <typeinfo>

#include "systems/framework/fields.h"
#include "systems/framework/never_allocates.h"

namespace flinch {

/// What a Context needs to know of a type to store its values in one block of memory.
struct ValueType {
  const std::type_info* id;
  std::size_t size;
  std::size_t alignment;
  void (*construct)(void* to);  ///< the default value
  void (*copy_construct)(void* to, const void* from);
  void (*copy_assign)(void* to, const void* from);
  void (*destroy)(void*);
  /// The numbers of a value that can be integrated; null for other types.
  std::span<double> (*numbers)(void*);
  /// Recording: null for types that cannot be recorded.
  RowLayout (*layout)();
  void (*to_row)(const void* value, internal::Number* row);
};

/// A value that a port or state can hold. That its copies do not touch the heap is checked apart, with a
/// message of its own: see never_allocates.
template <class T>
concept PortValue = std::is_object_v<T> && !std::is_const_v<T> && std::is_default_constructible_v<T> &&
                    std::is_copy_constructible_v<T> && std::is_copy_assignable_v<T>;

/// A value that can be integrated: a number or an Eigen matrix of bounded size.
template <class T>
concept ContinuousValue = std::is_same_v<T, double> || internal::BoundedMatrix<T>;

namespace internal {

template <class T>
constexpr ValueType make_value_type() {
  static_assert(
      never_allocates<T>,
      "a port or state may not hold this type, for its copies may allocate: in the place of strings, "
      "std::vector and dynamic matrices use numbers, std::array, fixed or bounded Eigen types, and plain "
      "structs of these (see never_allocates.h)");
  ValueType type{};
  type.id = &typeid(T);
  type.size = sizeof(T);
  type.alignment = alignof(T);
  type.construct = [](void* to) { ::new (to) T(); };
  type.copy_construct = [](void* to, const void* from) { ::new (to) T(*static_cast<const T*>(from)); };
  type.copy_assign = [](void* to, const void* from) { *static_cast<T*>(to) = *static_cast<const T*>(from); };
  type.destroy = [](void* value) { static_cast<T*>(value)->~T(); };
  if constexpr (std::is_same_v<T, double>) {
    type.numbers = [](void* value) { return std::span<double>(static_cast<double*>(value), 1); };
  } else if constexpr (BoundedMatrix<T>) {
    type.numbers = [](void* value) {
      T& matrix = *static_cast<T*>(value);
      return std::span<double>(matrix.data(), static_cast<std::size_t>(matrix.size()));
    };
  }
  if constexpr (Recordable<T>) {
    type.layout = &row_layout<T>;
    type.to_row = [](const void* value, Number* row) { write_row(*static_cast<const T*>(value), row); };
  }
  return type;
}

}  // namespace internal

/// The description of T; one object a type.
template <PortValue T>
inline constexpr ValueType value_type = internal::make_value_type<T>();

/// A value of `type` on the heap: the default value, or a copy of the one at `value`.
std::shared_ptr<const void> make_value(const ValueType& type);
std::shared_ptr<const void> make_value(const ValueType& type, const void* value);

}  // namespace flinch
