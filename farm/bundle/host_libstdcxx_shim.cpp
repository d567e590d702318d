/* Starts only if the machine's C++ library is at least as new as the one in the bundle (launch.c): the check of the index, which never
 * fails, is a function that only that version has (collect.py tests that). */
#define _GLIBCXX_ASSERTIONS
#include <cstddef>
#include <vector>

int main(int argc, char **)
{
    std::vector<int> values(std::size_t(argc), 0);
    return values[std::size_t(argc) - 1];
}
