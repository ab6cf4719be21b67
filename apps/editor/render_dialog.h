/// The final render: its settings, its progress, and the files that it writes.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QTimer>

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "apps/editor/view_camera.h"
#include "renderer/session/session.h"

namespace parian::editor {

class RenderDialog : public QDialog {
  Q_OBJECT

 public:
  /// Renders the scene as it is now, from one of its cameras or as the viewport sees it. `display_view` and
  /// `exposure` are those of the PNG.
  RenderDialog(std::shared_ptr<const Scene> scene, const ViewCamera& view, const QString& display_view,
               float exposure, QWidget* parent = nullptr);
  ~RenderDialog() override;

  bool is_rendering() const { return rendering_; }

 public slots:
  void start();
  void stop();
  void done(int result) override;

 signals:
  void finished_render();

 private:
  void make_form();
  void browse(QLineEdit* path, const QString& filter);
  void show_progress();
  void run(std::shared_ptr<const Scene> scene, const RenderSettings& settings, const std::string& exr,
           const std::string& png);
  QString problem() const;
  void end(const QString& text);

  std::shared_ptr<const Scene> scene_;
  ViewCamera view_;
  std::string display_view_;
  float exposure_;

  QComboBox* camera_;
  QSpinBox *width_, *height_, *samples_;
  QDoubleSpinBox* noise_;
  QLineEdit *exr_, *png_;
  QProgressBar* bar_;
  QLabel* text_;
  QPushButton *start_, *stop_;
  QTimer timer_;

  std::atomic<bool> rendering_{false}, stopping_{false};
  std::mutex mutex_;  // of the session, which the thread makes
  std::unique_ptr<Session> session_;
  std::thread thread_;
};

}  // namespace parian::editor
