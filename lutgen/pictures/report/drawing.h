// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace metamer::lutgen {

/// An inline SVG picture, in units of its own that the page scales. Looks are CSS classes of page.css, so that they
/// follow the reader's light or dark; colours that are the message itself are stated.
class Drawing {
 public:
  /// @param words  what a reader who cannot see it is told
  Drawing(int width, int height, const std::string& words);

  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::string& look);
  void path(const std::vector<Eigen::Vector2d>& points, const std::string& look, bool isClosed = false);
  /// @param fill  a colour, "#1f5fa8"
  void rectangle(double left, double top, double width, double height, const std::string& fill);
  void dot(const Eigen::Vector2d& centre, double radius, const std::string& fill);
  /// @param anchor  "start", "middle", "end"
  void text(double x, double y, const std::string& words, const std::string& anchor = "start",
            const std::string& look = "soft");

  std::string svg() const { return m_text + "</svg>"; }

 private:
  std::string m_text;
};

/// Text as HTML and XML hold it.
std::string escaped(const std::string& text);

}  // namespace metamer::lutgen
