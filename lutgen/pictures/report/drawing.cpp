// SPDX-License-Identifier: Apache-2.0
#include "report/drawing.h"

#include <kainjow/mustache.hpp>

#include "metamer/spectral/formatted.h"

namespace metamer::lutgen {

using spectral::formatted;

std::string escaped(const std::string& text) {
  return kainjow::mustache::html_escape(text);
}

Drawing::Drawing(int width, int height, const std::string& words)
    : m_text(formatted("<svg viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"%s\">", width, height,
                       escaped(words).c_str())) {}

void Drawing::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::string& look) {
  m_text += formatted("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" class=\"%s\"/>", from.x(), from.y(),
                      to.x(), to.y(), look.c_str());
}

void Drawing::path(const std::vector<Eigen::Vector2d>& points, const std::string& look, bool isClosed) {
  m_text += "<path class=\"" + look + "\" d=\"";
  const char* step = "M";
  for (const Eigen::Vector2d& point : points) {
    m_text += formatted("%s%.1f %.1f", step, point.x(), point.y());
    step = "L";
  }
  m_text += isClosed ? "Z\"/>" : "\"/>";
}

void Drawing::rectangle(double left, double top, double width, double height, const std::string& fill) {
  m_text += formatted("<rect x=\"%.4g\" y=\"%.4g\" width=\"%.4g\" height=\"%.4g\" fill=\"%s\"/>", left, top, width,
                      height, fill.c_str());
}

void Drawing::dot(const Eigen::Vector2d& centre, double radius, const std::string& fill) {
  m_text += formatted("<circle class=\"dot\" cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/>", centre.x(), centre.y(),
                      radius, fill.c_str());
}

void Drawing::text(double x, double y, const std::string& words, const std::string& anchor, const std::string& look) {
  m_text += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" class=\"%s\">%s</text>", x, y, anchor.c_str(),
                      look.c_str(), escaped(words).c_str());
}

}  // namespace metamer::lutgen
