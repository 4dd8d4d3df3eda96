// Templates of statements, for fuzz_program.c, which puts something in the place of each {x}.
#ifndef FUZZ_GRAMMAR_H
#define FUZZ_GRAMMAR_H

// A statement of one line, and one that encloses others; chosen at random.
const char *fuzz_grammar_statement(void);
const char *fuzz_grammar_block(void);

#endif
