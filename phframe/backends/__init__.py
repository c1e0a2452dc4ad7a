"""Physics engines: one ``Physics`` per engine, in a module named after it with a trailing underscore."""
