// Standard input, output and error of a program, where its main begins and ends.

#ifndef DIG_CORE_STREAMS_H
#define DIG_CORE_STREAMS_H

/// Opens /dev/null in the place of each that is closed, before anything else is opened: a table
/// whose descriptor became 2 would be written over by the next word on standard error. What is read
/// or written there fails as before. Exits with 1 where there is no /dev/null.
void dig_streams_begin(void);

/// Closes standard output and returns the exit status: code, or 1 where code is 0 and not all of
/// the output was written, as on a full disk; what failed then stands on standard error.
int dig_streams_end(const char *program, int code);

#endif // DIG_CORE_STREAMS_H
