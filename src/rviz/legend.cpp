#include "src/rviz/legend.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlayContainer.h>
#include <Overlay/OgreOverlayManager.h>

#include <QImage>
#include <QPainter>
#include <vector>

namespace desert_sim {

namespace {

/// Legends of several displays stand above one another: each has the lowest place that is free.
std::vector<bool>& places() {
  static std::vector<bool> taken;
  return taken;
}

std::size_t take_place() {
  std::vector<bool>& taken = places();
  std::size_t n = 0;
  while (n < taken.size() && taken[n]) ++n;
  if (n == taken.size()) taken.push_back(true);
  taken[n] = true;
  return n;
}

QColor to_qt(const render::Colour& c) {
  return QColor::fromRgbF(static_cast<qreal>(c.r), static_cast<qreal>(c.g), static_cast<qreal>(c.b));
}

QImage draw(const std::string& title, const render::Overlay& overlay, int width, int height) {
  QImage picture(width, height, QImage::Format_ARGB32);
  picture.fill(QColor(20, 20, 20, 160));
  QPainter painter(&picture);
  painter.setPen(Qt::white);
  painter.setFont(QFont("Sans", 9));
  const int margin = 8, bar_top = 24, bar_height = 14, bar_width = width - 2 * margin;
  painter.drawText(QRect(margin, 2, bar_width, 20), Qt::AlignLeft | Qt::AlignVCenter,
                   QString::fromStdString(title));
  for (int x = 0; x < bar_width; ++x) {
    painter.setPen(to_qt(colour_of(overlay.map, static_cast<float>(x) / static_cast<float>(bar_width - 1))));
    painter.drawLine(margin + x, bar_top, margin + x, bar_top + bar_height);
  }
  painter.setPen(Qt::white);
  const QRect numbers(margin, bar_top + bar_height + 2, bar_width, 20);
  const float middle = 0.5f * (overlay.low + overlay.high);
  const auto number = [](float value) {
    return QString::fromStdString(render::legend_number(static_cast<double>(value)));
  };
  painter.drawText(numbers, Qt::AlignLeft | Qt::AlignVCenter, number(overlay.low));
  painter.drawText(numbers, Qt::AlignHCenter | Qt::AlignVCenter, number(middle));
  painter.drawText(numbers, Qt::AlignRight | Qt::AlignVCenter, number(overlay.high));
  return picture;
}

}  // namespace

Legend::Legend() : place_(take_place()), name_("desert_sim/legend" + std::to_string(place_)) {
  const Ogre::String& group = Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME;
  texture_ = Ogre::TextureManager::getSingleton().createManual(name_, group, Ogre::TEX_TYPE_2D, width, height,
                                                               0, Ogre::PF_A8R8G8B8, Ogre::TU_DEFAULT);
  material_ = Ogre::MaterialManager::getSingleton().create(name_, group);
  Ogre::Pass* const pass = material_->getTechnique(0)->getPass(0);
  pass->setLightingEnabled(false);
  pass->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  pass->setDepthCheckEnabled(false);
  pass->setDepthWriteEnabled(false);
  pass->createTextureUnitState(name_);
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  overlay_ = overlays.create(name_);
  panel_ = overlays.createOverlayElement("Panel", name_);
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  panel_->setVerticalAlignment(Ogre::GVA_BOTTOM);
  panel_->setDimensions(width, height);
  constexpr int margin = 10;
  panel_->setPosition(margin, -static_cast<Ogre::Real>((static_cast<int>(place_) + 1) * (height + margin)));
  panel_->setMaterial(material_);
  overlay_->add2D(static_cast<Ogre::OverlayContainer*>(panel_));
}

Legend::~Legend() {
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  overlay_->remove2D(static_cast<Ogre::OverlayContainer*>(panel_));
  overlays.destroyOverlayElement(panel_);
  overlays.destroy(overlay_);
  Ogre::MaterialManager::getSingleton().remove(material_);
  Ogre::TextureManager::getSingleton().remove(texture_);
  places()[place_] = false;
}

void Legend::show(const std::string& title, const render::Overlay& overlay) {
  const std::string text = title + '\n' + std::to_string(overlay.low) + '\n' + std::to_string(overlay.high) +
                           '\n' + std::to_string(static_cast<int>(overlay.map));
  if (text != text_) {
    text_ = text;
    const QImage picture = draw(title, overlay, width, height);
    const Ogre::PixelBox pixels(width, height, 1, Ogre::PF_A8R8G8B8, const_cast<uchar*>(picture.constBits()));
    texture_->getBuffer()->blitFromMemory(pixels);
  }
  overlay_->show();
}

}  // namespace desert_sim
