#pragma once

#include <string>
#include <vector>

namespace flinch {

struct BoxNumbers;
struct CalibrationPlot;

/// A number with four digits, as people write it.
std::string short_number(double value);

// Each of these is one SVG element.

/// Two sets of points over one axis.
std::string scatter_drawing(const CalibrationPlot& plot);

/// Ellipses of one and two standard deviations of two parameters with this correlation, each counted in its
/// own deviation.
std::string ellipse_drawing(const std::string& x_name, const std::string& y_name, double correlation);

/// Box plots side by side.
std::string box_drawing(const std::vector<BoxNumbers>& boxes, const std::string& unit);

}  // namespace flinch
