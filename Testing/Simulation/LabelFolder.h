#pragma once

#include "ErrorText.h"

#include "Labels/ReadLabelMap.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace sono::testing {

/// Every test has a folder of its own that goes away with it.
class LabelFolder : public ::testing::Test
{
protected:
  std::string file(const std::string& name) const { return folder_.file(name); }
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
  TemporaryFolder folder_;
};

} // namespace sono::testing
