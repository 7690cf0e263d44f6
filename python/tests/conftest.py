"""Tests of Ctrl-C work in the background, too: a shell lets programs there ignore it."""

import signal

signal.signal(signal.SIGINT, signal.default_int_handler)
