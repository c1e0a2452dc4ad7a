"""Imported by the fork server where trials use what plugins offer: asked once, it need not be asked in every trial."""

from phframe.registry import catalogue

catalogue()
