#include "format/kind.h"

#include <gtest/gtest.h>

namespace synpo {
namespace {

using namespace std::string_view_literals;

TEST(Kind, IsToldByTheBeginning) {
  EXPECT_EQ(kind_of("\x02\x01\0\0\0\0\0\0"sv), FileKind::kCheckpoint);
  EXPECT_EQ(kind_of("\x02\x01\0\0\0\0\0\0{\"__metadata__\""sv), FileKind::kCheckpoint);
  EXPECT_EQ(kind_of("{\"format\":\"synpo\"}\n"), FileKind::kTrajectories);
  EXPECT_EQ(kind_of("{\"format"), FileKind::kTrajectories);
  EXPECT_EQ(kind_of("env\ttask\nmap1\tR-B\n"), FileKind::kTable);
  EXPECT_EQ(kind_of("\x89PNG\r\n"), FileKind::kPicture);
  for (const std::string_view other :
       {""sv, "x"sv, "no table"sv, "\0\0\0\0\0\0\0\0\0\0"sv, "\x01\ta"sv, "no\ntable\t"sv})
    EXPECT_EQ(kind_of(other), FileKind::kUnknown) << other;
}

TEST(Kind, WhatWasExpectedIsNotSaid) {
  EXPECT_EQ(another_kind("env\ttask", FileKind::kTable), "");
  EXPECT_EQ(another_kind("env\ttask", FileKind::kCheckpoint), " (this is a table)");
  EXPECT_EQ(another_kind("{", FileKind::kTable), " (this is JSON, as trajectories are)");
  EXPECT_EQ(another_kind("nothing", FileKind::kTable), "");
}

}  // namespace
}  // namespace synpo
