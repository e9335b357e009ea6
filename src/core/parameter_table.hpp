#pragma once
/// Parameter tables. A process keeps its parameters in a plain struct whose initialisers are the defaults.
/// Beside the struct is a table with one row per member, in the order of the members: name, range, unit and a
/// line of documentation. The YAML loader, ROS parameters, `--describe`, the generated documentation,
/// commands, journal and checkpoint all use this table.
///
///     struct Example { float height = 1; bool flat = false; };
///     constexpr auto parameter_table(const Example*) {
///       return std::make_tuple(parameter("height", &Example::height, 0, 10, "m", "How high."),
///                              parameter("flat", &Example::flat, "Whether it is flat."));
///     }
///     static_assert(table_is_complete<Example>());

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace desert_sim {

/// The upper limit of a parameter that may be any 64-bit integer: the double next to the largest, 2⁶⁴ − 1.
constexpr double highest_uint64 = 0x1p64;

/// A limit of a parameter of type T as text: all digits of whole numbers, six of others.
template <class T>
std::string limit_text(double limit) {
  if constexpr (std::is_integral_v<T>) {
    return limit >= highest_uint64 ? std::to_string(std::numeric_limits<std::uint64_t>::max())
                                   : std::to_string(static_cast<long long>(limit));
  } else {
    std::ostringstream text;
    text << limit;
    return text.str();
  }
}

/// A list of up to four numbers, for a parameter that is a short list.
struct ShortList {
  static constexpr int capacity = 4;
  float values[capacity] = {0, 0, 0, 0};
  int count = 0;
};

/// What a row says of its parameter, whatever the types of the struct and of the parameter.
struct ParameterRow {
  const char* name;
  double lowest, highest;      ///< allowed range of a number, or of each number in a list
  const char* unit;            ///< SI; "1" if dimensionless
  const char* doc;             ///< one line
  const char* const* choices;  ///< names of an enumeration's values, in order; null for other types
  int choice_count;
};

template <class Owner, class T>
struct Parameter : ParameterRow {
  T Owner::*member;
};

template <class Owner, class T>
constexpr Parameter<Owner, T> parameter(const char* name, T Owner::*member, double lowest, double highest,
                                        const char* unit, const char* doc) {
  return {{name, lowest, highest, unit, doc, nullptr, 0}, member};
}

/// The row of a boolean or string parameter.
template <class Owner, class T>
constexpr Parameter<Owner, T> parameter(const char* name, T Owner::*member, const char* doc) {
  static_assert(std::is_same_v<T, bool> || std::is_same_v<T, std::string>, "numbers need a range and a unit");
  return {{name, 0, 1, "", doc, nullptr, 0}, member};
}

/// The row of an enumeration; `choices[i]` is the name of the enumerator with value i.
template <class Owner, class T, int N>
constexpr Parameter<Owner, T> parameter(const char* name, T Owner::*member, const char* const (&choices)[N],
                                        const char* doc) {
  static_assert(std::is_enum_v<T>, "choices belong to an enumeration");
  return {{name, 0, N - 1, "", doc, choices, N}, member};
}

namespace detail {
template <class T>
struct IsOptionalNumber : std::false_type {};
template <class T>
struct IsOptionalNumber<std::optional<T>> : std::is_arithmetic<T> {};
}  // namespace detail

/// Whether T is a number that may be left out, which has no default: std::optional of a number.
template <class T>
inline constexpr bool is_optional_number = detail::IsOptionalNumber<T>::value;

template <class P>
constexpr auto table_of() {
  return parameter_table(static_cast<const P*>(nullptr));
}

/// Calls visit(row, value) for each parameter, in the table's order, with its own type. `P` may be const.
template <class P, class Visit>
void for_each_parameter(P& parameters, Visit&& visit) {
  std::apply([&](const auto&... row) { (visit(row, parameters.*(row.member)), ...); },
             table_of<std::remove_const_t<P>>());
}

namespace detail {
template <class Owner, class T>
constexpr std::size_t offset_after_member(std::size_t offset, const Parameter<Owner, T>&) {
  return (offset + alignof(T) - 1) / alignof(T) * alignof(T) + sizeof(T);
}
}  // namespace detail

/// True if the rows, in order, account for every byte of the struct except padding. A static_assert on it
/// reports a member without a row at compile time.
template <class P>
constexpr bool table_is_complete() {
  std::size_t size = 0;
  std::apply([&](const auto&... row) { ((size = detail::offset_after_member(size, row)), ...); },
             table_of<P>());
  return (size + alignof(P) - 1) / alignof(P) * alignof(P) == sizeof(P);
}

}  // namespace desert_sim
