"""One file format a module: values in and out of files. Files appear whole or not at all."""
