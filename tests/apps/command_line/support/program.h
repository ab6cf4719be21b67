/// The real `parian` program, run as a user would.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {

struct Outcome {
  int code = -1;  // exit code; -1 where the program was killed
  std::string out, err;
};

/// A running program; its output goes to files in `folder`.
class Program {
 public:
  Program(const std::vector<std::string>& arguments, const std::string& out, const std::string& err)
      : out_(out), err_(err) {
    std::vector<const char*> argv{PARIAN_PROGRAM};
    for (const std::string& a : arguments) argv.push_back(a.c_str());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      dup2(open(out_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644), STDOUT_FILENO);
      dup2(open(err_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644), STDERR_FILENO);
      execv(PARIAN_PROGRAM, const_cast<char* const*>(argv.data()));
      _exit(127);
    }
  }

  /// Waits until the program has taken hold of a signal, at most ten seconds.
  bool wait_for_handler(int signal) const {
    for (int i = 0; i < 2000; ++i) {
      std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
      for (std::string line; std::getline(status, line);)
        if (line.starts_with("SigCgt:") && (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1))
          return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  void send(int signal) const { kill(pid_, signal); }

  /// Empties what the program has open of `folder`, named or not.
  void truncate_open_file(const std::string& folder) const {
    for (const auto& entry : std::filesystem::directory_iterator("/proc/" + std::to_string(pid_) + "/fd")) {
      const bool is_in_folder = std::filesystem::read_symlink(entry).string().starts_with(folder);
      EXPECT_EQ(is_in_folder ? truncate(entry.path().c_str(), 0) : 0, 0);
    }
  }

  /// Waits for the end, two minutes at most.
  Outcome finish() const {
    int status = 0;
    for (int i = 0; waitpid(pid_, &status, WNOHANG) == 0; ++i) {
      if (i == 12000) kill(pid_, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(out_), read_bytes(err_)};
  }

 private:
  std::string out_, err_;
  pid_t pid_ = -1;
};

/// A folder of the test's own, with a scene in it, and `parian` to run.
class ProgramTest : public GltfTest {
 protected:
  void SetUp() override {
    GltfTest::SetUp();
    std::filesystem::create_directories(path("work"));
    std::filesystem::create_directories(path("log"));
    GltfBuilder builder;
    builder.add_triangle();
    builder.root["nodes"] = {{{"mesh", 0}}};
    builder.root["scenes"] = {{{"nodes", {0}}}};
    builder.root["scene"] = 0;
    triangle = write("work/triangle.glb", builder.glb());
  }

  std::unique_ptr<Program> start(const std::vector<std::string>& arguments) {
    return std::make_unique<Program>(arguments, path("log/out"), path("log/err"));
  }
  Outcome run(const std::vector<std::string>& arguments) { return start(arguments)->finish(); }

  /// A path in the folder that the test may write to.
  std::string work(const std::string& name) const { return path("work/" + name); }

  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path("work")))
      names.insert(entry.path());
    return names;
  }

  std::string triangle;  // a scene that lacks a camera and a light
};

}  // namespace parian
