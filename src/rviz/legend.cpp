#include "src/rviz/legend.hpp"

#include <QPainter>
#include <algorithm>
#include <vector>

namespace desert_sim {

namespace {

constexpr int legend_width = 250, legend_margin = 8, text_row = 20;  // [pixels]

QColor to_qt(const render::Colour& c) {
  return QColor::fromRgbF(static_cast<qreal>(c.r), static_cast<qreal>(c.g), static_cast<qreal>(c.b));
}

QImage background(int height) {
  QImage picture(legend_width, height, QImage::Format_ARGB32);
  picture.fill(QColor(20, 20, 20, 160));
  return picture;
}

void write_text(QPainter& painter, const QRect& place, Qt::Alignment side, const std::string& text) {
  painter.setPen(Qt::white);
  painter.setFont(QFont("Sans", 9));
  painter.drawText(place, static_cast<int>(side | Qt::AlignVCenter), QString::fromStdString(text));
}

constexpr int bar_top = 24, bar_height = 14, bar_width = legend_width - 2 * legend_margin;

/// A bar of the colours of the shares 0 … 1.
template <class ColourOfShare>
void draw_colour_bar(QPainter& painter, const std::string& title, const ColourOfShare& colour) {
  write_text(painter, {legend_margin, 2, bar_width, text_row}, Qt::AlignLeft, title);
  for (int x = 0; x < bar_width; ++x) {
    painter.setPen(colour(static_cast<float>(x) / static_cast<float>(bar_width - 1)));
    painter.drawLine(legend_margin + x, bar_top, legend_margin + x, bar_top + bar_height);
  }
}

QImage draw(const std::string& title, const render::Overlay& overlay) {
  QImage picture = background(64);
  QPainter painter(&picture);
  draw_colour_bar(painter, title, [&](float share) { return to_qt(colour_of(overlay.map, share)); });
  const QRect numbers(legend_margin, bar_top + bar_height + 2, bar_width, text_row);
  const auto number = [](float value) { return render::legend_number(static_cast<double>(value)); };
  write_text(painter, numbers, Qt::AlignLeft, number(overlay.low));
  write_text(painter, numbers, Qt::AlignHCenter, number(0.5f * (overlay.low + overlay.high)));
  write_text(painter, numbers, Qt::AlignRight, number(overlay.high));
  return picture;
}

QImage draw(const std::string& title, render::CostPalette palette) {
  using namespace render;
  QImage picture = background(88);
  QPainter painter(&picture);
  draw_colour_bar(painter, title, [&](float share) {
    const auto cost = static_cast<std::int8_t>(1 + share * (inscribed_cost - 2));
    QColor colour = to_qt(cost_colour(palette, cost));
    colour.setAlphaF(static_cast<qreal>(cost_opacity(cost, 1, 0, 0)));
    return colour;
  });
  const QRect words(legend_margin, bar_top + bar_height + 2, bar_width, text_row);
  write_text(painter, words, Qt::AlignLeft, "free");
  write_text(painter, words, Qt::AlignRight, "hard to pass");
  const auto box = [&](int left, const QBrush& brush, const std::string& text) {
    const int top = words.bottom() + 6;
    painter.fillRect(left, top, 14, 14, brush);
    write_text(painter, {left + 20, top - 3, bar_width, text_row}, Qt::AlignLeft, text);
  };
  box(legend_margin, to_qt(cost_colour(palette, lethal_cost)), "lethal");
  box(legend_margin + 66, to_qt(cost_colour(palette, inscribed_cost)), "inscribed");
  box(legend_margin + 158, QBrush(to_qt(unknown_cost_colour).lighter(200), Qt::BDiagPattern), "unknown");
  return picture;
}

}  // namespace

// ---- of colours

/// Whether the picture says this already; from now on it does.
bool Legend::is_shown(const std::string& text) { return std::exchange(text_, text) == text; }

void Legend::show(const std::string& title, const render::Overlay& overlay) {
  if (!is_shown(title + '\n' + std::to_string(overlay.low) + '\n' + std::to_string(overlay.high) + '\n' +
                std::to_string(static_cast<int>(overlay.map))))
    picture_.draw(draw(title, overlay));
  picture_.show();
}

void Legend::show(const std::string& title, render::CostPalette palette) {
  if (!is_shown(title + '\n' + std::to_string(static_cast<int>(palette))))
    picture_.draw(draw(title, palette));
  picture_.show();
}

// ---- of lines

std::shared_ptr<LineLegend> LineLegend::shared() {
  static std::weak_ptr<LineLegend> there;
  std::shared_ptr<LineLegend> legend = there.lock();
  if (!legend) there = legend = std::make_shared<LineLegend>();
  return legend;
}

void LineLegend::show(const void* owner, const std::string& name, const render::Colour& colour) {
  const Line line{name, render::pack(colour)};
  const auto before = lines_.find(owner);
  if (before != lines_.end() && before->second == line) return;
  lines_[owner] = line;
  draw();
}

void LineLegend::hide(const void* owner) {
  if (lines_.erase(owner) > 0) draw();
}

void LineLegend::draw() {
  if (lines_.empty()) return picture_.hide();
  std::vector<Line> sorted;
  for (const auto& [owner, line] : lines_) sorted.push_back(line);
  std::sort(sorted.begin(), sorted.end());
  QImage picture = background(8 + text_row * static_cast<int>(sorted.size()));
  QPainter painter(&picture);
  int top = 4;
  for (const Line& line : sorted) {
    const auto channel = [&](int bits) { return static_cast<int>(line.colour >> bits & 255); };
    painter.fillRect(legend_margin, top + text_row / 2 - 2, 28, 4,
                     QColor(channel(0), channel(8), channel(16)));
    write_text(painter, {legend_margin + 38, top, bar_width - 38, text_row}, Qt::AlignLeft, line.name);
    top += text_row;
  }
  painter.end();
  picture_.draw(picture);
  picture_.show();
}

}  // namespace desert_sim
