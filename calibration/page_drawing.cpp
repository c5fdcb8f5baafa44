#include "calibration/page_drawing.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibration/calibration_result.h"
#include "systems/foundation/html_page.h"

namespace flinch {
namespace {

constexpr double width = 380.0, height = 230.0;
constexpr double left = 58.0, right = 12.0, top = 26.0, bottom = 36.0;
constexpr std::size_t most_points = 1200;

/// A range of numbers on an axis of the drawing.
struct Axis {
  double low = 0.0, high = 1.0, from = 0.0, to = 1.0;

  double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

Axis axis(double low, double high, double from, double to) {
  if (!(high > low)) low -= 0.5, high += 0.5;
  const double room = 0.04 * (high - low);
  return {low - room, high + room, from, to};
}

/// Round numbers on the axis, three to seven of them: steps of 1, 2 or 5 times a power of ten.
std::vector<double> ticks(const Axis& axis) {
  const double rough = (axis.high - axis.low) / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= rough) step = factor * power;
  }
  std::vector<double> values;
  for (double k = std::ceil(axis.low / step); k * step <= axis.high; k += 1.0) values.push_back(k * step);
  return values;
}

/// A line across and a number for each round value of the upward axis.
std::string upward_grid(const Axis& y) {
  std::string svg;
  for (const double v : ticks(y)) {
    svg += fmt::format("<line class='grid' y1='{0:.1f}' y2='{0:.1f}' x1='{1}' x2='{2}'/>", y.at(v), left,
                       width - right);
    svg += fmt::format("<text class='tick' x='{}' y='{:.1f}' text-anchor='end'>{}</text>", left - 5,
                       y.at(v) + 3, short_number(v));
  }
  return svg;
}

std::string frame(const std::string& title, const std::string& x_label, const std::string& y_label,
                  const Axis& x, const Axis& y) {
  std::string svg =
      fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='{}'>", width, height, escaped(title));
  svg += fmt::format("<text class='title' x='{}' y='16'>{}</text>", left, escaped(title));
  svg += fmt::format("<rect class='frame' x='{}' y='{}' width='{}' height='{}'/>", left, top,
                     width - left - right, height - top - bottom);
  for (const double u : ticks(x)) {
    svg += fmt::format("<line class='grid' x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2}'/>", x.at(u), top,
                       height - bottom);
    svg += fmt::format("<text class='tick' x='{:.1f}' y='{}' text-anchor='middle'>{}</text>", x.at(u),
                       height - bottom + 13, short_number(u));
  }
  svg += upward_grid(y);
  svg += fmt::format("<text class='label' x='{}' y='{}' text-anchor='end'>{}</text>", width - right,
                     height - 6, escaped(x_label));
  svg += fmt::format("<text class='label' x='{}' y='16' text-anchor='end'>{}</text>", width - right,
                     escaped(y_label));
  return svg;
}

std::string points(const std::vector<double>& x, const std::vector<double>& y, const Axis& across,
                   const Axis& up, const char* name) {
  std::string path;
  const std::size_t step = 1 + x.size() / most_points;
  for (std::size_t k = 0; k < x.size(); k += step)
    path += fmt::format("M{:.1f} {:.1f}h0", across.at(x[k]), up.at(y[k]));
  return fmt::format("<path class='{}' d='{}'/>", name, path);
}

std::string ellipse(double correlation, double radius, const Axis& x, const Axis& y) {
  std::string path;
  for (int i = 0; i <= 72; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 72.0;
    // (cos, r cos + sqrt(1 - r^2) sin) has the covariance [1 r; r 1].
    const double u = std::cos(angle);
    const double v =
        correlation * u + std::sqrt(std::max(0.0, 1.0 - correlation * correlation)) * std::sin(angle);
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x.at(radius * u), y.at(radius * v));
  }
  return fmt::format("<path class='ellipse' d='{}Z'/>", path);
}

}  // namespace

std::string short_number(double value) {
  return fmt::format("{:.4g}", std::abs(value) < 1e-12 ? 0.0 : value);
}

std::string scatter_drawing(const CalibrationPlot& plot) {
  if (plot.x.empty()) return "";
  const auto [first, last] = std::minmax_element(plot.x.begin(), plot.x.end());
  double low = plot.after.front(), high = low;
  for (const std::vector<double>* values : {&plot.before, &plot.after}) {
    for (const double value : *values) low = std::min(low, value), high = std::max(high, value);
  }
  const Axis x = axis(*first, *last, left, width - right);
  const Axis y = axis(low, high, height - bottom, top);
  return frame(plot.title, plot.x_name + " [" + plot.x_unit + "]", plot.y_name + " [" + plot.y_unit + "]", x,
               y) +
         points(plot.x, plot.before, x, y, "before") + points(plot.x, plot.after, x, y, "after") + "</svg>";
}

std::string ellipse_drawing(const std::string& x_name, const std::string& y_name, double correlation) {
  const Axis x = axis(-2.5, 2.5, left, width - right);
  const Axis y = axis(-2.5, 2.5, height - bottom, top);
  return frame(fmt::format("correlation {:.2f}", correlation), x_name, y_name, x, y) +
         ellipse(correlation, 1.0, x, y) + ellipse(correlation, 2.0, x, y) + "</svg>";
}

std::string box_drawing(const std::vector<BoxNumbers>& boxes, const std::string& unit) {
  if (boxes.empty()) return "";
  double low = boxes.front().low, high = boxes.front().high;
  for (const BoxNumbers& box : boxes) low = std::min(low, box.low), high = std::max(high, box.high);
  const Axis y = axis(low, high, height - bottom, top);
  const double slot = (width - left - right) / static_cast<double>(boxes.size());
  std::string svg = fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='errors'>", width, height);
  svg += fmt::format("<text class='label' x='{}' y='16'>error [{}]</text>", left, escaped(unit));
  svg += upward_grid(y);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const BoxNumbers& box = boxes[i];
    const double middle = left + (static_cast<double>(i) + 0.5) * slot;
    const double half = 0.28 * slot;
    svg += fmt::format("<path class='whisker' d='M{0:.1f} {1:.1f}V{2:.1f}'/>", middle, y.at(box.low),
                       y.at(box.high));
    svg += fmt::format("<rect class='box' x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'/>",
                       middle - half, y.at(box.quartile3), 2.0 * half,
                       std::max(1.0, y.at(box.quartile1) - y.at(box.quartile3)));
    svg += fmt::format("<path class='median' d='M{:.1f} {:.1f}h{:.1f}'/>", middle - half, y.at(box.median),
                       2.0 * half);
    svg += fmt::format("<text class='tick' x='{:.1f}' y='{}' text-anchor='middle'>{}</text>", middle,
                       height - bottom + 13 + (i % 2 == 1 ? 10.0 : 0.0), escaped(box.name));
  }
  return svg + "</svg>";
}

}  // namespace flinch
