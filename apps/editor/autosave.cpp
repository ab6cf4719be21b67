#include "apps/editor/autosave.h"

#include <signal.h>
#include <unistd.h>

#include <QDir>
#include <QFile>
#include <QJsonDocument>
#include <QJsonObject>

#include <cerrno>
#include <exception>

#include "renderer/base/file.h"

namespace parian::editor {
namespace {

QString notes_of(const QString& file) { return file + ".json"; }

bool is_running(qint64 process) { return process > 0 && (kill(pid_t(process), 0) == 0 || errno == EPERM); }

}  // namespace

Autosave::Autosave(Document& document, const QString& folder, int interval_milliseconds, QObject* parent)
    : QObject(parent),
      document_(document),
      file_(QDir(folder).filePath(QString("%1.glb").arg(getpid()))),
      written_(document.is_modified() ? nullptr : document.share()) {  // what was recovered is unsaved
  QDir().mkpath(folder);
  connect(&timer_, &QTimer::timeout, this, &Autosave::write);
  timer_.start(interval_milliseconds);
}

Autosave::~Autosave() {
  if (thread_.joinable()) thread_.join();
  remove({file_, ""});
}

void Autosave::write() {
  if (!document_.is_modified()) {
    if (!busy_) remove({file_, ""});
    return;
  }
  if (busy_ || document_.is_dragging() || written_ == document_.share()) return;
  if (thread_.joinable()) thread_.join();
  busy_ = true;
  written_ = document_.share();
  const QJsonObject notes{{"original", document_.path()}, {"process", qint64(getpid())}};
  thread_ = std::thread([this, writer = document_.writer(), text = QJsonDocument(notes).toJson()] {
    try {
      // In this order: a copy without notes would not be found.
      write_file(notes_of(file_).toStdString(), std::string_view(text.constData(), std::size_t(text.size())));
      writer(file_);
    } catch (const std::exception&) {
      // A full disk, or a folder that is gone: the scene itself is as it was, and the next edit tries again.
    }
    busy_ = false;
  });
}

void Autosave::write_now() {
  write();
  if (thread_.joinable()) thread_.join();
}

std::optional<Backup> Autosave::find(const QString& folder) {
  for (const QFileInfo& file : QDir(folder).entryInfoList({"*.glb"}, QDir::Files, QDir::Time)) {
    QFile notes(notes_of(file.filePath()));
    if (!notes.open(QIODevice::ReadOnly)) continue;
    const QJsonObject object = QJsonDocument::fromJson(notes.readAll()).object();
    if (is_running(object["process"].toInteger())) continue;
    return Backup{file.filePath(), object["original"].toString()};
  }
  return std::nullopt;
}

void Autosave::remove(const Backup& backup) {
  QFile::remove(backup.file);
  QFile::remove(notes_of(backup.file));
}

}  // namespace parian::editor
