"""Physics engines: one package per engine, named after it, and what engines of joints share."""
