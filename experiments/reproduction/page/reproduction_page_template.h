#pragma once

#include <string_view>

namespace flinch {

/// The page of reproduced figures with its style and scripts inlined, up to the place where the JSON data
/// goes, and from there on. Generated from the files beside this header.
extern const std::string_view reproduction_page_template_before_data;
extern const std::string_view reproduction_page_template_after_data;

}  // namespace flinch
