#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "systems/framework/fields.h"

namespace flinch {

namespace internal {
template <class T>
constexpr bool holds_nothing_on_the_heap();
}

/// Whether copies of a T never touch the heap: a port or state may then hold it. It is seen from its parts:
/// numbers and what else can be copied bytewise, Eigen types of fixed or bounded size, std::array, and plain
/// structs of at most 48 such (an array that is no std::array counts as its elements).
///
/// Of a class with private members, or a larger struct, nothing can be seen. Where its author knows, he says
/// so beside it:
///
///   template <>
///   inline constexpr bool flinch::never_allocates<RingOfSamples> = true;
template <class T>
inline constexpr bool never_allocates = internal::holds_nothing_on_the_heap<T>();

namespace internal {

/// Becomes any member of an Aggregate, and promises not to throw only where that never allocates.
template <class Aggregate>
struct AnyMember {
  template <class Member>
  // NOLINTNEXTLINE(google-explicit-constructor): an aggregate is initialised from it.
  requires(!std::same_as<Member, Aggregate>) operator Member() const noexcept(never_allocates<Member>);
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-braces"  // an array that is a member takes its elements one by one
#pragma GCC diagnostic ignored "-Wconversion"      // std::optional takes its value, and not itself
template <class T, std::size_t... i>
constexpr bool can_be_made_of(std::index_sequence<i...>) {
  return requires { T{(static_cast<void>(i), AnyMember<T>())...}; };
}

template <class T, std::size_t... i>
constexpr bool is_made_without_throwing(std::index_sequence<i...>) {
  return noexcept(T{(static_cast<void>(i), AnyMember<T>())...});
}

#pragma GCC diagnostic pop

/// How many members T has, or 48 of more: from `count` on, where what is left out can be, as many as it can
/// be made of.
template <class T, std::size_t count = 0>
constexpr std::size_t members() {
  constexpr std::size_t most = 48;
  constexpr bool is_enough = can_be_made_of<T>(std::make_index_sequence<count>());
  constexpr bool is_all = !can_be_made_of<T>(std::make_index_sequence<count + 1>());
  if constexpr ((is_enough && is_all) || count == most)
    return count;
  else
    return members<T, count + 1>();
}

template <class T>
constexpr bool holds_nothing_on_the_heap() {
  if constexpr (std::is_trivially_copyable_v<T>) {
    return true;
  } else if constexpr (std::derived_from<T, Eigen::EigenBase<T>>) {
    if constexpr (BoundedMatrix<T>) return never_allocates<typename T::Scalar>;
    return false;
  } else if constexpr (is_std_array<T>) {
    return never_allocates<typename T::value_type>;
  } else if constexpr (std::is_aggregate_v<T>) {
    using All = std::make_index_sequence<members<T>()>;
    using More = std::make_index_sequence<members<T>() + 1>;
    if constexpr (can_be_made_of<T>(All()) && !can_be_made_of<T>(More()))
      return is_made_without_throwing<T>(All());
  }
  return false;
}

}  // namespace internal
}  // namespace flinch
