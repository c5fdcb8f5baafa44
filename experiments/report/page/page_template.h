#pragma once

#include <string_view>

namespace flinch {

/// The page with its style, scripts and dygraphs inlined, up to the place where the JSON data goes, and from
/// there on. Generated from the files beside this header by page_template.cmake.
extern const std::string_view page_template_before_data;
extern const std::string_view page_template_after_data;

}  // namespace flinch
