from thalweg.operations.dredging.loading_curves import LoadingCurve
from thalweg.operations.dredging.project import Project
from thalweg.operations.dredging.project_environment import (
    ProjectEnvironment,
    freeze_site_network,
    project_network,
)
from thalweg.operations.dredging.project_inputs import (
    example_file,
    open_project,
    open_project_inputs,
)
from thalweg.operations.dredging.project_parts import BaseCase, SiteNetworkOptions, Sites, WorkScope
from thalweg.operations.dredging.project_result import ProjectResult, ProjectRun
from thalweg.operations.dredging.run_project import run_project

__all__ = [
    "BaseCase",
    "LoadingCurve",
    "Project",
    "ProjectEnvironment",
    "ProjectResult",
    "ProjectRun",
    "SiteNetworkOptions",
    "Sites",
    "WorkScope",
    "example_file",
    "freeze_site_network",
    "open_project",
    "open_project_inputs",
    "project_network",
    "run_project",
]
