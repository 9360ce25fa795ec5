from thalweg.studies.annual_figures import annual_figures
from thalweg.studies.front_statistics import front_statistics
from thalweg.studies.ready_studies import ready_studies, ready_study
from thalweg.studies.study import Study, load_study
from thalweg.studies.study_run import StudyProgress, run_study
from thalweg.studies.study_summary import StudySummary, study_rows, summarise_study

__all__ = [
    "Study",
    "StudyProgress",
    "StudySummary",
    "annual_figures",
    "front_statistics",
    "load_study",
    "ready_studies",
    "ready_study",
    "run_study",
    "study_rows",
    "summarise_study",
]
