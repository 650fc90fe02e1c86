// The commands of synpo-matrix, and what they share.
#pragma once

namespace synpo {

constexpr int kMostFiles = 100000;

int matrix_split(int argc, char** argv);
int matrix_summary(int argc, char** argv);
int matrix_table(int argc, char** argv);
int matrix_compare(int argc, char** argv);
int matrix_rows(int argc, char** argv);
int matrix_cols(int argc, char** argv);
int matrix_show(int argc, char** argv);
int matrix_filter(int argc, char** argv);
int matrix_wide(int argc, char** argv);
int matrix_merge(int argc, char** argv);

}  // namespace synpo
