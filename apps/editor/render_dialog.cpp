#include "apps/editor/render_dialog.h"

#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>

#include <chrono>
#include <exception>

#include "images/image_io.h"
#include "integrators/integrators.h"
#include "renderer/color/display.h"
#include "renderer/scene/world.h"
#include "renderer/session/session.h"

namespace parian::editor {

RenderDialog::RenderDialog(std::shared_ptr<const Scene> scene, const ViewCamera& view,
                           const QString& display_view, float exposure, QWidget* parent)
    : QDialog(parent),
      scene_(std::move(scene)),
      view_(view),
      display_view_(display_view.toStdString()),
      exposure_(exposure) {
  setWindowTitle(tr("Render"));
  make_form();
  connect(&timer_, &QTimer::timeout, this, &RenderDialog::show_progress);
}

RenderDialog::~RenderDialog() {
  stop();
  if (thread_.joinable()) thread_.join();
}

void RenderDialog::make_form() {
  auto* form = new QFormLayout(this);
  camera_ = new QComboBox(this);
  camera_->addItem(tr("as the viewport sees it"), kNone);
  const std::vector<CameraPlacement> cameras = place_cameras(*scene_);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Node& node = scene_->nodes[std::size_t(cameras[i].node)];
    const std::string name =
        node.name.empty() ? scene_->cameras[std::size_t(cameras[i].camera)].name : node.name;
    camera_->addItem(name.empty() ? tr("camera %1").arg(i) : QString::fromStdString(name), int(i));
  }
  camera_->setCurrentIndex(cameras.empty() ? 0 : 1);
  form->addRow(tr("Camera"), camera_);
  const auto number = [&](const QString& label, int value, int most) {
    auto* box = new QSpinBox(this);
    box->setRange(1, most);
    box->setValue(value);
    form->addRow(label, box);
    return box;
  };
  width_ = number(tr("Width [pixels]"), 1280, 65536);
  height_ = number(tr("Height [pixels]"), 720, 65536);
  samples_ = number(tr("Samples for each pixel"), 256, 1 << 24);
  noise_ = new QDoubleSpinBox(this);
  noise_->setDecimals(4);
  noise_->setRange(0, 10);
  noise_->setSingleStep(0.005);
  noise_->setSpecialValueText(tr("all samples"));
  form->addRow(tr("Ends at a noise of"), noise_);
  const auto file = [&](const QString& label, const QString& name, const QString& filter) {
    auto* row = new QWidget(this);
    auto* layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    auto* path = new QLineEdit(name, row);
    auto* button = new QPushButton(tr("..."), row);
    layout->addWidget(path, 1);
    layout->addWidget(button);
    connect(button, &QPushButton::clicked, this, [=, this] { browse(path, filter); });
    form->addRow(label, row);
    return path;
  };
  exr_ = file(tr("EXR"), QDir::current().filePath("render.exr"), tr("OpenEXR (*.exr)"));
  png_ = file(tr("PNG"), QDir::current().filePath("render.png"), tr("PNG (*.png)"));
  exr_->setObjectName("exr");
  png_->setObjectName("png");
  bar_ = new QProgressBar(this);
  bar_->setRange(0, 1000);
  form->addRow(bar_);
  text_ = new QLabel(this);
  text_->setObjectName("text");
  text_->setWordWrap(true);
  form->addRow(text_);
  start_ = new QPushButton(tr("Render"), this);
  stop_ = new QPushButton(tr("Stop"), this);
  stop_->setEnabled(false);
  start_->setDefault(true);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(start_);
  buttons->addWidget(stop_);
  form->addRow(buttons);
  connect(start_, &QPushButton::clicked, this, &RenderDialog::start);
  connect(stop_, &QPushButton::clicked, this, &RenderDialog::stop);
}

void RenderDialog::browse(QLineEdit* path, const QString& filter) {
  const QString chosen = QFileDialog::getSaveFileName(this, tr("Write to"), path->text(), filter);
  if (!chosen.isEmpty()) path->setText(chosen);
}

QString RenderDialog::problem() const {
  const auto check = [](const QString& path, const QString& extension) -> QString {
    if (path.isEmpty()) return "";
    const QFileInfo file(path);
    if (file.suffix() != extension) return tr("%1: expected a name that ends in .%2").arg(path, extension);
    if (!QFileInfo(file.absolutePath()).isWritable())
      return tr("%1: expected a folder that can be written to").arg(file.absolutePath());
    return "";
  };
  if (exr_->text().isEmpty() && png_->text().isEmpty())
    return tr("expected the name of a file, EXR, PNG or both");
  const QString exr = check(exr_->text(), "exr");
  return exr.isEmpty() ? check(png_->text(), "png") : exr;
}

void RenderDialog::start() {
  if (rendering_) return;
  if (const QString what = problem(); !what.isEmpty()) return text_->setText(what);
  if (thread_.joinable()) thread_.join();
  rendering_ = true;
  stopping_ = false;
  start_->setEnabled(false);
  stop_->setEnabled(true);
  text_->setText(tr("building"));
  const int camera = camera_->currentData().toInt();
  const auto scene = camera == kNone ? std::make_shared<const Scene>(with_view(*scene_, view_)) : scene_;
  RenderSettings settings;
  settings.camera = camera == kNone ? 0 : camera;
  settings.width = width_->value();
  settings.height = height_->value();
  settings.spp = std::uint32_t(samples_->value());
  settings.noise = noise_->value();
  thread_ = std::thread([this, scene, settings, exr = exr_->text().toStdString(),
                         png = png_->text().toStdString()] { run(scene, settings, exr, png); });
  timer_.start(100);
}

void RenderDialog::stop() { stopping_ = true; }

// On the thread of the render. What was rendered when it was stopped is written, too.
void RenderDialog::run(std::shared_ptr<const Scene> scene, const RenderSettings& settings,
                       const std::string& exr, const std::string& png) {
  QString result;
  try {
    require_image_library();
    auto session = std::make_unique<Session>(std::move(scene), settings, make_integrator("path", {}));
    Session& rendered = *session;
    {
      const std::lock_guard lock(mutex_);
      session_ = std::move(session);
      if (!stopping_) rendered.start();
    }
    // This thread alone starts, ends and awaits it.
    while (!stopping_ && rendered.progress().running)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (stopping_) rendered.cancel();
    rendered.wait();
    if (rendered.frames() == 0)
      throw std::runtime_error("stopped before there was a picture; nothing is written");
    const Picture picture = rendered.snapshot();
    if (!exr.empty()) write_exr(picture, exr);
    if (!png.empty()) write_display_image(apply_display(picture, display_view_, exposure_), png);
    const std::string names = exr.empty() || png.empty() ? exr + png : exr + ", " + png;
    result = (stopping_ ? tr("stopped; written: %1") : tr("written: %1")).arg(QString::fromStdString(names));
  } catch (const std::exception& error) {
    result = QString::fromUtf8(error.what());
  }
  QMetaObject::invokeMethod(
      this, [this, result] { end(result); }, Qt::QueuedConnection);
}

void RenderDialog::end(const QString& text) {
  timer_.stop();
  if (thread_.joinable()) thread_.join();
  show_progress();
  {
    const std::lock_guard lock(mutex_);
    session_.reset();
  }
  rendering_ = false;
  start_->setEnabled(true);
  stop_->setEnabled(false);
  text_->setText(text);
  emit finished_render();
}

void RenderDialog::show_progress() {
  const std::lock_guard lock(mutex_);
  if (!session_) return;
  const Progress progress = session_->progress();
  bar_->setValue(int(1000 * progress.done));
  text_->setText(tr("%1 of %2 samples, %3 s")
                     .arg(progress.samples)
                     .arg(progress.total)
                     .arg(progress.seconds, 0, 'f', 1));
}

void RenderDialog::done(int result) {
  stop();
  if (thread_.joinable()) thread_.join();
  QDialog::done(result);
}

}  // namespace parian::editor
