#include "renderer/compare/plane.h"

#include <gtest/gtest.h>

namespace parian {
namespace {

Plane of_values(int width, int height, const std::vector<float>& values) {
  Plane plane(width, height);
  plane.values = values;
  return plane;
}

// A convolution turns its kernel round: a spike becomes the kernel as it is written.
TEST(Plane, FiltersConvolve) {
  const Kernel kernel{1, 2, 4};
  EXPECT_EQ(filter_rows(of_values(5, 1, {0, 0, 1, 0, 0}), kernel).values,
            (std::vector<float>{0, 1, 2, 4, 0}));
  EXPECT_EQ(filter_columns(of_values(1, 5, {0, 0, 1, 0, 0}), kernel).values,
            (std::vector<float>{0, 1, 2, 4, 0}));
}

// Caught: a border of zeros, and reading outside of pictures smaller than the kernel.
TEST(Plane, TheBorderGoesOn) {
  const Kernel kernel{1, 1, 1, 1, 1};
  EXPECT_EQ(filter_rows(of_values(2, 2, {1, 2, 3, 4}), kernel).values, (std::vector<float>{7, 8, 17, 18}));
  EXPECT_EQ(filter_columns(of_values(2, 2, {1, 2, 3, 4}), kernel).values,
            (std::vector<float>{9, 14, 11, 16}));
  EXPECT_EQ(filter_rows(of_values(1, 1, {3}), kernel).values, std::vector<float>{15});
}

TEST(Plane, MeanIsExactForManyPixels) {
  Plane plane(4096, 4096);
  for (float& value : plane.values) value = 0.1f;
  EXPECT_NEAR(mean(plane), 0.1f, 1e-9);
}

}  // namespace
}  // namespace parian
