/// Help for tests of the editor's windows, which run on Qt's platform "offscreen".
#pragma once

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <QTest>

#include <functional>
#include <string>

namespace parian::editor {

/// Runs the event loop until `holds`, for half a minute at most. Whether it did.
inline bool wait_for(const std::function<bool()>& holds) { return QTest::qWaitFor(holds, 30000); }

inline QString scene_file(const std::string& name) {
  return QString::fromStdString(std::string(PARIAN_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".gltf");
}

/// A folder of its own, and settings and autosaves of its own.
class EditorTest : public testing::Test {
 protected:
  EditorTest() {
    QStandardPaths::setTestModeEnabled(true);
    QCoreApplication::setOrganizationName("parian");
    QCoreApplication::setApplicationName(
        QString("parian-test-%1-%2")
            .arg(testing::UnitTest::GetInstance()->current_test_info()->name())
            .arg(QCoreApplication::applicationPid()));
  }
  QString path(const QString& name) const { return folder_.filePath(name); }

  QTemporaryDir folder_;
};

}  // namespace parian::editor
