#pragma once

#include <string_view>

namespace flinch {

/// The page of a run that goes on with its style, scripts and dygraphs inlined, up to the place where the
/// JSON data goes, and from there on. Generated from the files beside this header and those of the report's
/// page.
extern const std::string_view live_page_template_before_data;
extern const std::string_view live_page_template_after_data;

}  // namespace flinch
