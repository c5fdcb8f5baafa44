#pragma once

#include <string>

namespace flinch {

/// A JSON value on one line. Bytes that are no UTF-8, as names of files may have, become U+FFFD.
template <class Json>
std::string json_text(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace flinch
