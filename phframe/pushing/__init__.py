"""The paper's geometry: corridor, persistence, grouping, sweep, reach. What planners are made of."""
