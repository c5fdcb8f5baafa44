#pragma once

#include <string_view>

namespace flinch {

/// The page of a diagram with its style and scripts inlined, up to the place where the JSON data goes, and
/// from there on. Generated from the files beside this header and those of the report.
extern const std::string_view graph_page_template_before_data;
extern const std::string_view graph_page_template_after_data;

}  // namespace flinch
