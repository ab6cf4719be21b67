/// Help for tests of the editor's windows, which run on Qt's platform "offscreen".
#pragma once

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QFile>
#include <QSettings>
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

/// A folder of its own, and settings and autosaves of its own in it.
class EditorTest : public testing::Test {
 protected:
  EditorTest() {
    QCoreApplication::setOrganizationName("parian");
    QCoreApplication::setApplicationName("parian-test");
    qputenv("XDG_DATA_HOME", path("data").toUtf8());
    qputenv("XDG_CONFIG_HOME", path("config").toUtf8());
    QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope, path("config"));
  }
  QString path(const QString& name) const { return folder_.filePath(name); }
  /// A copy of a scene of one buffer that can be written over.
  QString copy_scene(const QString& name) const {
    const QString source = scene_file(name.toStdString());
    const QString bin = source.chopped(4) + "bin";
    EXPECT_TRUE(QFile::copy(source, path(name + ".gltf"))) << source.toStdString();
    EXPECT_TRUE(QFile::copy(bin, path(name + ".bin"))) << bin.toStdString();
    for (const char* extension : {".gltf", ".bin"})
      QFile::setPermissions(path(name + extension), QFile::ReadUser | QFile::WriteUser);
    return path(name + ".gltf");
  }

  QTemporaryDir folder_;
};

}  // namespace parian::editor
