/// Copies of a document while it is unsaved, and what is found of a program that crashed.
#pragma once

#include <QObject>
#include <QString>
#include <QTimer>

#include <atomic>
#include <optional>
#include <thread>

#include "apps/editor/document.h"

namespace parian::editor {

/// A copy that a program left that is no more.
struct Backup {
  QString file;      // the copy, a .glb
  QString original;  // what it is a copy of; "": it was never saved
};

class Autosave : public QObject {
  Q_OBJECT

 public:
  /// Writes into `folder`, one file for each running program, some seconds after an edit and then every
  /// `interval` while there are more.
  Autosave(Document& document, const QString& folder, int interval_milliseconds, QObject* parent = nullptr);
  /// The copy goes: the program ends as it should.
  ~Autosave() override;

  /// The newest copy in a folder whose program is gone; it stays until remove().
  static std::optional<Backup> find(const QString& folder);
  static void remove(const Backup& backup);

  /// Now, and waits for it. For tests.
  void write_now();

 private:
  void write();

  Document& document_;
  QString file_;
  QTimer timer_;
  std::shared_ptr<const Scene> written_;
  std::thread thread_;
  std::atomic<bool> busy_{false};
};

}  // namespace parian::editor
