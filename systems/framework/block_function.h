#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#include "systems/framework/place.h"

namespace flinch {

class System;

/// A member function of a block with its types erased: reads its arguments from, and writes its result to,
/// the memory of a Context at `places` (the arguments in order, then the result).
using BlockFunction = void (*)(const System& block, std::byte* memory, const Place* places);

namespace internal {

template <class T>
inline constexpr bool is_result_argument =
    std::is_lvalue_reference_v<T> && !std::is_const_v<std::remove_reference_t<T>>;

template <class... Ts>
using LastOf = std::tuple_element_t<sizeof...(Ts) - 1, std::tuple<Ts...>>;

/// Splits the parameters of a member function into values read and result written.
template <class Member>
struct MemberSignature;

template <class Block_, class Return, class... Parameters>
struct MemberSignature<Return (Block_::*)(Parameters...) const> {
  using Block = Block_;
  static constexpr bool returns = true;
  static constexpr std::size_t arguments = sizeof...(Parameters);
  using Result = std::remove_cvref_t<Return>;
  using Values = std::tuple<std::remove_cvref_t<Parameters>...>;
  static_assert((!is_result_argument<Parameters> && ...),
                "a function that returns its result may not write to an argument");
};

template <class Block_, class... Parameters>
struct MemberSignature<void (Block_::*)(Parameters...) const> {
  static_assert(sizeof...(Parameters) > 0,
                "a function of a block returns its result or takes it as last argument");
  using Block = Block_;
  static constexpr bool returns = false;
  static constexpr std::size_t arguments = sizeof...(Parameters) - 1;
  static_assert(is_result_argument<LastOf<Parameters...>>, "the last argument must be Result&");
  static_assert((static_cast<std::size_t>(is_result_argument<Parameters>) + ...) == 1,
                "only the last argument may be written");
  using Result = std::remove_cvref_t<LastOf<Parameters...>>;
  using Values = std::tuple<std::remove_cvref_t<Parameters>...>;  // the result comes last
};

template <class Block, class Return, class... Parameters>
struct MemberSignature<Return (Block::*)(Parameters...) const noexcept>
    : MemberSignature<Return (Block::*)(Parameters...) const> {};

template <auto function>
using Signature = MemberSignature<decltype(function)>;

template <class T>
T& at(std::byte* memory, Place place) {
  return *reinterpret_cast<T*>(place.in(memory));
}

template <class T>
const T& at(const std::byte* memory, Place place) {
  return *reinterpret_cast<const T*>(place.in(memory));
}

template <auto function, std::size_t... i>
void call_with(const System& system, std::byte* memory, const Place* places, std::index_sequence<i...>) {
  using S = Signature<function>;
  const auto& block = static_cast<const typename S::Block&>(system);
  auto& result = at<typename S::Result>(memory, places[sizeof...(i)]);
  if constexpr (S::returns) {
    result = (block.*
              function)(std::as_const(at<std::tuple_element_t<i, typename S::Values>>(memory, places[i]))...);
  } else {
    (block.*function)(std::as_const(at<std::tuple_element_t<i, typename S::Values>>(memory, places[i]))...,
                      result);
  }
}

template <auto function>
void call(const System& system, std::byte* memory, const Place* places) {
  call_with<function>(system, memory, places, std::make_index_sequence<Signature<function>::arguments>());
}

template <auto function, class... Values>
constexpr void check_arguments() {
  using S = Signature<function>;
  static_assert(sizeof...(Values) == S::arguments,
                "the declaration names more or fewer values than the function takes");
  if constexpr (sizeof...(Values) == S::arguments) {
    []<std::size_t... i>(std::index_sequence<i...>) {
      static_assert((std::is_same_v<Values, std::tuple_element_t<i, typename S::Values>> && ...),
                    "the declaration names a value of another type than the function takes");
    }
    (std::make_index_sequence<S::arguments>());
  }
}

template <auto function, class T>
constexpr void check_result() {
  static_assert(std::is_same_v<typename Signature<function>::Result, T>,
                "the function computes another type than the state holds");
}

}  // namespace internal
}  // namespace flinch
