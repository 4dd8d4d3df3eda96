"""PC side of the StepMite motion controller."""
