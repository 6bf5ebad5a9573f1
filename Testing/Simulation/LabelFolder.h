#pragma once

#include "ErrorText.h"

#include "Labels/ReadLabelMap.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace sono::testing {

/// Every test has a folder of its own that goes away with it.
class LabelFolder : public ::testing::Test
{
protected:
  void SetUp() override
  {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("sono_" + std::string(info->test_suite_name()) + "_" + std::string(info->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string text(const std::string& name, const std::string& content) const
  {
    std::ofstream(file(name), std::ios::binary) << content;
    return file(name);
  }
  std::string refusal(const std::string& name) const
  {
    return errorOf([&] { readLabelMap(file(name)); });
  }

private:
  std::filesystem::path folder_;
};

} // namespace sono::testing
