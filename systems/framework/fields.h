#pragma once

#include <Eigen/Core>
#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace flinch {

/// A value says of what it consists, once, so that it can be recorded, replayed and documented:
///
///   struct JointReading {
///     Time acquired{};
///     JointVector active;
///     template <class Self, class Visit>
///     static void fields(Self& self, Visit&& visit) {
///       visit("acquired", "ns", self.acquired);
///       visit("active", "rad", self.active);  // a fourth argument names the frame
///     }
///   };
///
/// A unit that is not the same for every mechanism is the name of a quantity in angle brackets, "<pose>":
/// see unit_table.h.
///
/// Fields are numbers, bool, enumerations, durations, Eigen matrices of bounded size, std::array of these,
/// and other values with fields.
template <class T>
concept HasFields = requires(T& value) {
  T::fields(value, [](const auto&...) {});
};

namespace internal {

template <class T>
concept Duration = requires {
  typename T::period;
}
&&std::same_as<T, std::chrono::nanoseconds>;

template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T> || Duration<T>;

template <class T>
concept BoundedMatrix = std::derived_from<T, Eigen::PlainObjectBase<T>> &&(T::MaxSizeAtCompileTime > 0);

template <class T>
inline constexpr bool is_std_array = false;
template <class T, std::size_t size>
inline constexpr bool is_std_array<std::array<T, size>> = true;

}  // namespace internal

/// A type whose values can be recorded and replayed.
template <class T>
concept Recordable = HasFields<T> || internal::Scalar<T> || internal::BoundedMatrix<T>;

/// One column of a recorded value.
struct Field {
  enum class Kind : std::uint8_t { real, integer, boolean };
  std::string name;   ///< nested fields are joined by '.', e.g. "wrench.force"
  std::string unit;   ///< SI; "" for a number without unit; "<pose>": that of a quantity
  std::string frame;  ///< "" where the value has none
  Kind kind{};
  int capacity = 1;        ///< most numbers that it can hold
  bool resizable = false;  ///< whether rows and columns may differ from sample to sample
};

/// How a value of one type is laid out in a row of a recording: each field is `capacity` numbers of 8 bytes,
/// and two more (rows, columns) before them where it is resizable.
struct RowLayout {
  std::vector<Field> fields;
  std::size_t numbers = 0;  ///< 8-byte numbers in a row
};

namespace internal {

/// Collects the fields of a layout. It knows the name of the value that is just being laid out.
class LayoutBuilder {
 public:
  /// Goes on with a part of that value, or with an element of an array. Returns what leave() needs.
  std::size_t enter(const char* part);
  std::size_t enter(std::size_t element);
  void leave(std::size_t entered);

  /// That value is a field: a number, or a matrix of at most `capacity` numbers.
  void add(Field::Kind kind, int capacity, bool resizable, const char* unit, const char* frame);

  RowLayout layout;

 private:
  std::string name_;
};

/// Calls leaf(scalar or matrix) for every leaf of `value`.
template <class T, class Leaf>
void for_each_leaf(T& value, Leaf& leaf) {
  using Value = std::remove_const_t<T>;
  if constexpr (HasFields<Value>) {
    Value::fields(value, [&leaf](const char*, const char*, auto& member, const char* = "") {
      for_each_leaf(member, leaf);
    });
  } else if constexpr (is_std_array<Value>) {
    for (auto& element : value) for_each_leaf(element, leaf);
  } else {
    leaf(value);
  }
}

template <class T>
constexpr Field::Kind kind_of() {
  if constexpr (std::is_same_v<T, bool>) return Field::Kind::boolean;
  if constexpr (std::is_floating_point_v<T>) return Field::Kind::real;
  return Field::Kind::integer;
}

/// Lays a value out, leaf by leaf.
template <class T>
void lay_out(LayoutBuilder& builder, const char* unit, const char* frame, T& value) {
  if constexpr (HasFields<T>) {
    T::fields(value,
              [&builder](const char* part, const char* part_unit, auto& member, const char* part_frame = "") {
                const std::size_t entered = builder.enter(part);
                lay_out(builder, part_unit, part_frame, member);
                builder.leave(entered);
              });
  } else if constexpr (is_std_array<T>) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::size_t entered = builder.enter(i);
      lay_out(builder, unit, frame, value[i]);
      builder.leave(entered);
    }
  } else if constexpr (Scalar<T>) {
    builder.add(kind_of<T>(), 1, false, unit, frame);
  } else {
    static_assert(BoundedMatrix<T>, "a field must be a number, a bounded matrix or have fields");
    static_assert(std::is_same_v<typename T::Scalar, double>);
    builder.add(Field::Kind::real, T::MaxSizeAtCompileTime, T::SizeAtCompileTime == Eigen::Dynamic, unit,
                frame);
  }
}

/// Eight bytes of a row: a real or an integer, as the field's kind says.
union Number {
  double real;
  std::int64_t integer;
};
static_assert(sizeof(Number) == 8);

template <class T>
void scalar_to_number(const T& value, Number& number) {
  if constexpr (std::is_floating_point_v<T>) {
    number.real = static_cast<double>(value);
  } else if constexpr (Duration<T>) {
    number.integer = value.count();
  } else {
    number.integer = static_cast<std::int64_t>(value);
  }
}

template <class T>
void number_to_scalar(const Number& number, T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    value = static_cast<T>(number.real);
  } else if constexpr (Duration<T>) {
    value = T(number.integer);
  } else {
    value = static_cast<T>(number.integer);
  }
}

/// Writes the leaves of a value one after the other into a row.
struct RowWriter {
  Number* next;

  template <class T>
  void operator()(const T& value) {
    if constexpr (Scalar<T>) {
      scalar_to_number(value, *next++);
    } else {
      if constexpr (T::SizeAtCompileTime == Eigen::Dynamic) {
        (next++)->integer = value.rows();
        (next++)->integer = value.cols();
      }
      const Eigen::Index size = value.size();
      for (Eigen::Index i = 0; i < T::MaxSizeAtCompileTime; ++i) {
        next[i].real = i < size ? value.data()[i] : 0.0;
      }
      next += T::MaxSizeAtCompileTime;
    }
  }
};

/// Whether a T can have this size.
template <class T>
constexpr bool fits(std::int64_t rows, std::int64_t columns) {
  const bool row_count = T::RowsAtCompileTime == Eigen::Dynamic ? rows >= 0 : rows == T::RowsAtCompileTime;
  const bool column_count =
      T::ColsAtCompileTime == Eigen::Dynamic ? columns >= 0 : columns == T::ColsAtCompileTime;
  return row_count && column_count && rows <= T::MaxRowsAtCompileTime && columns <= T::MaxColsAtCompileTime;
}

/// The inverse of RowWriter. Sizes that a matrix cannot have leave it as it is and make the row not good.
struct RowReader {
  const Number* next;
  bool good = true;

  template <class T>
  void operator()(T& value) {
    if constexpr (Scalar<T>) {
      number_to_scalar(*next++, value);
    } else {
      if constexpr (T::SizeAtCompileTime == Eigen::Dynamic) {
        const std::int64_t rows = (next++)->integer;
        const std::int64_t columns = (next++)->integer;
        if (fits<T>(rows, columns)) {
          value.resize(rows, columns);
        } else {
          good = false;
        }
      }
      for (Eigen::Index i = 0; i < value.size(); ++i) value.data()[i] = next[i].real;
      next += T::MaxSizeAtCompileTime;
    }
  }
};

}  // namespace internal

/// The layout of a row that holds a T.
template <Recordable T>
RowLayout row_layout() {
  internal::LayoutBuilder builder;
  T value{};
  internal::lay_out(builder, "", "", value);
  return std::move(builder.layout);
}

/// Writes `value` into a row of row_layout<T>().numbers numbers. Never allocates.
template <Recordable T>
void write_row(const T& value, internal::Number* row) {
  internal::RowWriter writer{row};
  internal::for_each_leaf(value, writer);
}

/// Reads back what write_row wrote, bit for bit. Returns false where a matrix of the row has a size that it
/// cannot have.
template <Recordable T>
[[nodiscard]] bool read_row(const internal::Number* row, T& value) {
  internal::RowReader reader{row};
  internal::for_each_leaf(value, reader);
  return reader.good;
}

}  // namespace flinch
