/* Generates the constants and the names of a choice from one list, so that their order and number always agree:
 *
 *     #define EDGES_CHOICE (EDGES_CLOSED, "closed")(EDGES_OPEN, "open")
 *     enum { CHOICE_CONSTANTS(EDGES_CHOICE) };                           EDGES_CLOSED, EDGES_OPEN,
 *     const char *words = CHOICE_TEXT(EDGES_CHOICE);                     "closed|open"
 *     const char *const word[] = {CHOICE_LIST(EDGES_CHOICE)};            "closed", "open",
 */
#ifndef HOODOO_CHOICE_H
#define HOODOO_CHOICE_H

/* Each macro consumes one pair and expands to the name of its partner, which consumes the next pair. _END is appended to the
 * last name, and that name expands to nothing. */
#define CHOICE_CONSTANTS(list) CHOICE_END(CHOICE_CONSTANT_A list)
#define CHOICE_CONSTANT_A(constant, word) constant, CHOICE_CONSTANT_B
#define CHOICE_CONSTANT_B(constant, word) constant, CHOICE_CONSTANT_A
#define CHOICE_CONSTANT_A_END
#define CHOICE_CONSTANT_B_END

#define CHOICE_LIST(list) CHOICE_END(CHOICE_LIST_A list)
#define CHOICE_LIST_A(constant, word) word, CHOICE_LIST_B
#define CHOICE_LIST_B(constant, word) word, CHOICE_LIST_A
#define CHOICE_LIST_A_END
#define CHOICE_LIST_B_END

/* Skips the leading bar. */
#define CHOICE_TEXT(list) (&(CHOICE_END(CHOICE_TEXT_A list))[1])
#define CHOICE_TEXT_A(constant, word) "|" word CHOICE_TEXT_B
#define CHOICE_TEXT_B(constant, word) "|" word CHOICE_TEXT_A
#define CHOICE_TEXT_A_END
#define CHOICE_TEXT_B_END

#define CHOICE_END(...) CHOICE_END_(__VA_ARGS__)
#define CHOICE_END_(...) __VA_ARGS__##_END

#endif
